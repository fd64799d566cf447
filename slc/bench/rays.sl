// SPDX-License-Identifier: Apache-2.0
// Shaders that wait for rays, for trace_bench.cpp: -DTRACES=n, n calls of trace and little else; or one of -DMIRROR,
// -DGLASS, -DLAYERED, as scenes have them.
#if defined(MIRROR)
surface rays(float Kr = 0.8)
{
    normal Nf = faceforward(normalize(N), I);
    Oi = Os;
    Ci = Os * Cs * (0.1 * diffuse(Nf) + Kr * trace(P, reflect(I, Nf)));
}
#elif defined(GLASS)
surface rays(float eta = 1.5, Ks = 0.5, roughness = 0.05; color transmitted = 1)
{
    vector In = normalize(I), R, T;
    normal Nf = faceforward(normalize(N), I);
    float kr, kt;
    fresnel(In, Nf, (In . N < 0) ? 1 / eta : eta, kr, kt, R, T);
    color c = Ks * specular(Nf, -In, roughness);
    if (kr > 0.001)
        c += kr * trace(P, R);
    if (kt > 0.001)
        c += kt * transmitted * trace(P, T);
    Oi = 1;
    Ci = c;
}
#elif defined(LAYERED)
surface rays(float Ka = 0.3, Kd = 0.6, Kr = 0.3, coat = 0.04, blur = 0.1, samples = 4, freq = 4)
{
    normal Nf = faceforward(normalize(N), I);
    vector V = -normalize(I);
    point PP = transform("shader", P) * freq;
    color base = mix(Cs, color(0.2, 0.1, 0.05), smoothstep(0.4, 0.6, float noise(PP)));
    color c = base * (Ka * ambient() + Kd * diffuse(Nf));
    vector R = reflect(-V, Nf);
    float i, fres = coat + (1 - coat) * pow(1 - abs(V . Nf), 5);
    color glossy = 0;
    for (i = 0; i < samples; i += 1)
        glossy += trace(P, R + blur * (vector random() - vector(0.5, 0.5, 0.5)));
    c += Kr * glossy / samples * base + fres * trace(P, R);
    illuminance (P, Nf, PI / 2)
        c += 0.1 * Cl * specularbrdf(normalize(L), Nf, V, 0.1);
    Oi = Os;
    Ci = Os * c;
}
#else
surface rays()
{
    color c = Cs;
#if TRACES > 0
    c += trace(P, N);
#endif
#if TRACES > 1
    c += trace(P, N * 2) * c;
#endif
#if TRACES > 2
    c += trace(P, N * 3) * c;
#endif
#if TRACES > 3
    c += trace(P, N * 4) * c;
#endif
    Oi = Os;
    Ci = c;
}
#endif
