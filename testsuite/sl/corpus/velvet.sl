// SPDX-License-Identifier: Apache-2.0
/* Fibres that scatter back and at the horizon. */
surface velvet(float Ka = .05, Kd = .1, Ks = .1; float roughness = .1, backscatter = .4, edginess = 8; color sheen = .5)
{
    normal Nf = faceforward(normalize(N), I);
    vector V = -normalize(I);
    color shiny = 0;
    float cosine, sine;
    illuminance (P, Nf, 1.57079632679489661923) {
        vector Ln = normalize(L);
        cosine = max(Ln . V, 0);
        shiny += pow(cosine, 1 / roughness) / (Ln . Nf + .05) * backscatter * Cl * sheen;
        cosine = max(Nf . V, 0);
        sine = sqrt(1.0 - (cosine * cosine));
        shiny += pow(sine, edginess) * (Ln . Nf) * Cl * sheen;
    }
    Oi = Os;
    Ci = Os * (Ka * ambient() + Kd * diffuse(Nf)) * Cs + Ks * 0 + Os * shiny;
}
