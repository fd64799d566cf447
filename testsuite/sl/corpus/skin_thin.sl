// SPDX-License-Identifier: Apache-2.0
/* Light scattered in a thin layer: fresnel in and out, Henyey and Greenstein phase function, three scatterings. */
float phase(vector a, b; float g)
{
    float costheta = -a . b;
    float denom = 1 + g * g - 2 * g * costheta;
    return (1 - g * g) / pow(denom, 1.5);
}
color scatter(vector Vin, Lin; normal Nn; float eta, thickness, g; color albedo)
{
    float win = abs(Lin . Nn), wo = abs(Vin . Nn);
    float x = win / (win + wo);
    color single = albedo * x * (1 - exp(-(1 / win + 1 / wo) * thickness));
    return single * phase(Vin, Lin, g) / PI;
}
surface skin_thin(float Ka = 1, Ks = .3, eta = 1 / 1.4, thickness = 1, roughness = .25, oil = .5; color blood = color (.9, .4, .3))
{
    normal Nf = faceforward(normalize(N), I);
    vector IN = normalize(I), V = -IN;
    float Kr, Kt, Kr2, Kt2;
    vector R, T, R2, T2;
    fresnel(IN, Nf, eta, Kr, Kt, R, T);
    color Cscat = 0, Cspec = 0;
    illuminance (P, Nf, PI / 2) {
        vector Ln = normalize(L);
        vector H = normalize(Ln + V);
        if (Ln . Nf > 0) {
            fresnel(-Ln, Nf, eta, Kr2, Kt2, R2, T2);
            uniform float g = .8;
            color sum = scatter(T, -T2, Nf, eta, thickness, g, blood) + scatter(T, -T2, Nf, eta, thickness, g * g, Cs)
                + scatter(T, -T2, Nf, eta, thickness, 0, Cs * blood);
            Cscat += Cl * (Ln . Nf) * sum * (1 - Kr2) * (1 - Kr);
            Cspec += Cl * oil * Kr * pow(max(0, H . Nf), 1 / roughness);
        }
    }
    Oi = Os;
    Ci = Oi * (Cs * Ka * ambient() + Cscat + Ks * Cspec + Cs * .3 * diffuse(Nf));
}
