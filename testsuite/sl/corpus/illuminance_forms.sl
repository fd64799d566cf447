// SPDX-License-Identifier: Apache-2.0
// Every form of illuminance, with category, cone and options; L, Cl in a function through extern.
float wrap_amount(normal n; float wrap)
{
    extern vector L;
    return max(0, (normalize(L).n + wrap) / (1 + wrap));
}
surface illuminance_forms(float wrap = .2; string kind = "key")
{
    normal Nf = faceforward(normalize(N), I);
    color C = 0;
    float spread = 0;
    illuminance(P) C += Cl * .1;
    illuminance(P, Nf, PI / 2) {
        float skip = 0;
        lightsource("__nondiffuse", skip);
        if (skip == 1) continue;
        C += (1 - skip) * Cl * wrap_amount(Nf, wrap);
    }
    illuminance(kind, P) { C += Cl; break; }
    illuminance("-" "key", P, Nf, 1.2, "lightcache", "reuse", "light:spread", spread) {
        extern color Cl;
        C += spread * Cl * Ol;
    }
    Oi = Os;
    Ci = Os * Cs * C;
}
