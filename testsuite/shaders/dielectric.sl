/* SPDX-License-Identifier: Apache-2.0
 * Fresnel reflection and refraction, index on the inside over index outside; all energy is kept. */
surface dielectric(float index = 1.5)
{
    normal Nn = normalize(N);
    vector In = normalize(I);
    normal Nf = faceforward(Nn, In);
    float eta = (Nn . In < 0) ? 1 / index : index;
    float kr, kt;
    vector R, T;
    fresnel(In, Nf, eta, kr, kt, R, T);
    Oi = 1;
    Ci = kr * color trace(P, R);
    if (kr < 1)
        Ci += (1 - kr) * color trace(P, T);
}
