// SPDX-License-Identifier: Apache-2.0
/* Refraction and reflection by rays, absorption by the length inside, opacity for shadow rays. */
#ifdef BMRT
#define TRACED 1
#endif
surface clear_glass(float Ka = .2, Kd = 0, Ks = .5, Kr = 1, Kt = 1, roughness = .05, eta = 1.5; color transmitcolor = color (.95, 1, .97))
{
    normal Nf = faceforward(normalize(N), I);
    vector IN = normalize(I), V = -IN;
    float kr = Kr, kt = Kt;
    vector Rfldir, Rfrdir;
    uniform float samples = 1, i = 0;
    color reflected = 0, refracted = 0;
    fresnel(IN, Nf, (I . N < 0) ? 1 / eta : eta, kr, kt, Rfldir, Rfrdir);
    kt = 1 - kr;
#ifdef TRACED
    if (isshadowray() == 0) {
        if (kr > .01)
            reflected = Kr * kr * trace(P, Rfldir);
        if (kt > .01)
            refracted = Kt * kt * transmitcolor * trace(P, Rfrdir);
        Oi = 1;
    } else {
        Oi = 1 - kt * transmitcolor;
    }
#endif
    Ci = Os * (Cs * (Ka * ambient() + Kd * diffuse(Nf)) + Ks * specular(Nf, V, roughness)) + reflected + refracted;
}
