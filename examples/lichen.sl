// SPDX-License-Identifier: Apache-2.0
// Lichen on stone: octaves of noise that stop where they would be finer than a sample, taken only where the stone is
// damp. Shows area operators that guide a loop, and one below a varying condition (docs/area_operators.md).
float size_of(point p)
{
    return max(sqrt(area(p)), 1e-6);
}
float octaves(point p; float width, most;)
{
    float sum = 0, gain = 1, fw = width, i;
    point pp = p;
    for (i = 0; i < most; i += 1) {
        float fade = 1 - smoothstep(.25, .75, fw);
        if (fade <= 0)
            break;
        sum += gain * fade * (2 * noise(pp) - 1);
        pp *= 2;
        fw *= 2;
        gain *= .5;
    }
    return sum;
}
surface lichen(float Ka = .3, Kd = .8, freq = 3; color stone = color(.4, .38, .35), growth = color(.5, .55, .2);)
{
    point PP = freq * transform("shader", P);
    float damp = noise(PP * .5);
    color c = stone * (1 + .3 * octaves(PP, size_of(PP), 6));
    if (damp > .5) {
        point QQ = PP * 4 + 10;
        float cover = smoothstep(.1, .3, octaves(QQ, size_of(QQ), 4));
        c = mix(c, growth, cover * smoothstep(.5, .6, damp));
    }
    normal Nf = faceforward(normalize(N), I);
    Oi = Os;
    Ci = Oi * c * (Ka * ambient() + Kd * diffuse(Nf));
}
