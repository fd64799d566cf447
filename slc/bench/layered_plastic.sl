/* SPDX-License-Identifier: Apache-2.0
 * Benchmark: plastic under five layers, each a pattern with a colour, an opacity and a gloss of its own, as
 * layered surface shaders of films are. */
#define LAYER(colour, opacity, gloss)                                                                                  \
    layer_opacity = clamp(opacity, 0, 1);                                                                              \
    Ct = mix(Ct, colour, layer_opacity);                                                                               \
    Kt = mix(Kt, gloss, layer_opacity)

float disc(float x, y, cx, cy, radius, soft)
{
    float dx = x - cx, dy = y - cy;
    return 1 - smoothstep(radius - soft, radius + soft, sqrt(dx * dx + dy * dy));
}

float steps(point p; uniform float octaves)
{
    float sum = 0, amplitude = .5;
    point q = p;
    uniform float i;
    for (i = 0; i < octaves; i += 1) {
        sum += amplitude * (2 * noise(q) - 1);
        q = 2.17 * q + vector(3, 7, 11);
        amplitude *= .5;
    }
    return sum;
}

surface layered_plastic(float Ka = .2, Kd = .7, Ks = .5, roughness = .1; color base = color(.8, .1, .05);
                        float stripes = 6, stripe_width = .3, dots = 8, dot_radius = .3;
                        float dirt = .5, scratches = .4, wear = .3; string decal = "";)
{
    point Q = transform("shader", P);
    color Ct = base;
    float Kt = Ks, layer_opacity;

    float band = mod(t * stripes, 1);
    LAYER(color(.95, .95, .9), smoothstep(.5 - stripe_width, .52 - stripe_width, band) *
          (1 - smoothstep(.48 + stripe_width, .5 + stripe_width, band)), .6);
    float ds = mod(s * dots, 1), dt = mod(t * dots, 1);
    float pick = cellnoise(floor(s * dots), floor(t * dots));
    LAYER(color(.1, .2, .7), disc(ds, dt, .5, .5, dot_radius * (.5 + .5 * pick), .03), .7);
    if (decal != "") {
        LAYER(color texture(decal, s, t), float texture(decal[3], s, t), .2);
    }
    float dull = smoothstep(.05, .4, steps(2 * Q, 5));
    LAYER(color(.25, .2, .15), dirt * dull, .05);
    float scratch = abs(noise(Q * vector(60, 4, 60)) - .5);
    LAYER(mix(Ct, color(.9, .9, .9), .5), scratches * (1 - smoothstep(.01, .03, scratch)), .9);
    float rub = pow(abs(noise(5 * Q)), 3) * wear;
    LAYER(color(.7, .68, .65), rub * step(.1, rub), .3);

    normal Nf = faceforward(normalize(N), I);
    vector V = -normalize(I);
    float Kr, Kx;
    fresnel(-V, Nf, 1 / 1.45, Kr, Kx);
    uniform vector to_light = normalize(vector(1, 2, -3));
    vector H = normalize(V + to_light);
    float shine = pow(max(0, Nf . H), 1 / roughness);
    Oi = Os;
    Ci = Os * (Ct * Cs * (Ka * ambient() + Kd * (diffuse(Nf) + max(0, Nf . to_light))) +
               Kt * (shine + specular(Nf, V, roughness)) + .2 * Kr);
}
