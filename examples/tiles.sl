// SPDX-License-Identifier: Apache-2.0
// Tiles with a soft edge, a relief and a map: the operators of docs/area_operators.md in one shader.
float filterwidth(float x)
{
    extern float du, dv;
    return max(abs(Du(x)) * du + abs(Dv(x)) * dv, 1e-6);
}
surface tiles(float freq = 8, Km = .1; string map = "";)
{
    point PP = P + Km * noise(freq * P) * normalize(N);
    normal Nf = faceforward(normalize(calculatenormal(PP)), I);
    float ss = s * freq;
    float w = filterwidth(ss);
    float x = mod(ss, 1);
    color c = mix(color (.2, .1, .05), Cs, smoothstep(.4 - w, .4 + w, x));
    if (map != "")
        c *= texture(map, ss, t);
    Oi = Os;
    Ci = Oi * c * (ambient() + diffuse(Nf));
}
