// SPDX-License-Identifier: Apache-2.0
// A solid of glass, or the water in it: reflection and refraction by Fresnel's formulas. `eta` is the index outside over the
// index inside, seen from outside.
surface glass(float eta = .6667, Ks = .6, roughness = .02;)
{
    normal Nn = normalize(N);
    vector In = normalize(I);
    normal Nf = faceforward(Nn, In);
    float index = (In.Nn < 0) ? eta : 1 / eta;
    float kr, kt;
    vector R, T;
    fresnel(In, Nf, index, kr, kt, R, T);
    color c = kr * color trace(P, R);
    if (kt > 0)
        c += Cs * kt * color trace(P, T);
    Oi = 1;
    Ci = c + Ks * specular(Nf, -In, roughness);
}
