// SPDX-License-Identifier: Apache-2.0
/* A raised superelliptic badge and a groove around it; the height is fetched by the surface through an output. */
displacement emboss(float Km = .05, sx = .5, sy = .5, rx = .3, ry = .2, power = 4; output varying float height = 0;)
{
    float x = abs(s - sx) / rx, y = abs(t - sy) / ry;
    float d = pow(pow(x, power) + pow(y, power), 1 / power);
    height = 1 - smoothstep(.9, 1, d) - .5 * (smoothstep(1.05, 1.1, d) - smoothstep(1.15, 1.2, d));
    P += Km * height * normalize(N);
    N = calculatenormal(P);
}
surface badge(color raised = color (1, .8, .2); float Ks = .5;)
{
    float height = 0;
    if (displacement("height", height) != 1)
        height = .5;
    normal Nf = faceforward(normalize(N), I);
    Oi = Os;
    Ci = Os * (mix(Cs, raised, clamp(height, 0, 1)) * (ambient() + diffuse(Nf)) + Ks * specular(Nf, -normalize(I), .1));
}
