// SPDX-License-Identifier: Apache-2.0
// grained: a turned piece of wood: growth rings about the shader's z axis, wobbled by noise, with fine fibres.
// Parameters: Ka, Kd, Ks, roughness  as in plastic
//             rings                  rings per unit of shader space
//             wobble                 how far a ring strays from its circle, in rings
//             light, dark            colours of early and late wood.
// Source: the ring pattern is [Perlin85]'s; constants ours.
surface grained(float Ka = 1; float Kd = .8; float Ks = .2; float roughness = .12; float rings = 7;
                float wobble = .7; color light = color(.72, .48, .26); color dark = color(.38, .2, .09);)
{
    normal Nf = faceforward(normalize(N), I);
    vector V = -normalize(I);
    point here = transform("shader", P);
    float x = xcomp(here), y = ycomp(here), z = zcomp(here);

    // Noise is stretched along the trunk: wood changes slowly there.
    float stray = noise(point(x * 1.5, y * 1.5, z * .3)) - .5;
    float ring = rings * sqrt(x * x + y * y) + 2 * wobble * stray;
    float late = ring - floor(ring);
    // Late wood ends abruptly where the next ring begins.
    late = smoothstep(.2, .85, late) * (1 - smoothstep(.93, 1, late));
    float fibre = noise(point(x * 40, y * 40, z * 1.2));

    color wood = mix(light, dark, late) * (.85 + .3 * fibre);
    Oi = Os;
    Ci = Os * (wood * (Ka * ambient() + Kd * diffuse(Nf)) + Ks * specular(Nf, V, roughness));
}
