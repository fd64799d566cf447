// SPDX-License-Identifier: Apache-2.0
/* Uses ray tracing where the compiler has it. */
surface glass_bmrt(float Kr = .8, Kt = .9, eta = 1.5, roughness = .05, blur = 0; uniform float samples = 1;
                   string envname = "";)
{
    normal Nf = faceforward(normalize(N), I);
    vector IN = normalize(I), R, T;
    float kr, kt;
    color cr = 0, ct = 0;
    fresnel(IN, Nf, (I.N < 0) ? 1 / eta : eta, kr, kt, R, T);
    kt = 1 - kr;
#if defined(BMRT) || defined(RAYSERVER_H)
    if (raylevel() < 4) {
        float i;
        for (i = 0; i < samples; i += 1)
            cr += trace(P, R + blur * (vector random() - vector (.5, .5, .5)));
        cr /= samples;
        ct = trace(P, T) * visibility(P, P + T);
    }
#else
    cr = 0;
#endif
    if (envname != "")
        cr += color environment(envname, vtransform("world", R), "blur", blur);
    Oi = 1;
    Ci = Kr * kr * cr + Kt * kt * ct + specular(Nf, -IN, roughness);
}
