/* SPDX-License-Identifier: Apache-2.0
 * Local illumination beyond diffuse() and specular(): lights are asked for their __nondiffuse and __nonspecular.
 * Oren and Nayar 1994, Ward 1992. Written for Perigee to the names that published shaders expect. */
#ifndef LOCILLUM_H
#define LOCILLUM_H 1

color LocIllumDiffuse(normal N; vector V)
{
    return diffuse(N);
}

color LocIllumOrenNayar(normal N; vector V; float roughness)
{
    float sigma2 = roughness * roughness;
    float A = 1 - .5 * sigma2 / (sigma2 + .33);
    float B = .45 * sigma2 / (sigma2 + .09);
    float theta_r = acos(V . N);
    vector V_perp_N = normalize(V - N * (V . N));
    color C = 0;
    extern point P;
    illuminance (P, N, PI / 2) {
        extern vector L;
        extern color Cl;
        float nondiff = 0;
        lightsource("__nondiffuse", nondiff);
        if (nondiff < 1) {
            vector LN = normalize(L);
            float cos_theta_i = LN . N;
            float cos_phi_diff = V_perp_N . normalize(LN - N * cos_theta_i);
            float theta_i = acos(cos_theta_i);
            float alpha = max(theta_i, theta_r);
            float beta = min(theta_i, theta_r);
            C += (1 - nondiff) * Cl * cos_theta_i * (A + B * max(0, cos_phi_diff) * sin(alpha) * tan(beta));
        }
    }
    return C;
}

/* A specular lobe whose edge is sharpened. */
color LocIllumGlossy(normal N; vector V; float roughness, sharpness)
{
    color C = 0;
    float w = sharpness / 2;
    extern point P;
    illuminance (P, N, PI / 2) {
        extern vector L;
        extern color Cl;
        float nonspec = 0;
        lightsource("__nonspecular", nonspec);
        if (nonspec < 1) {
            vector H = normalize(normalize(L) + V);
            C += Cl * ((1 - nonspec) * smoothstep(w, 1 - w, pow(max(0, N . H), 1 / roughness)));
        }
    }
    return C;
}

color LocIllumWardAnisotropic(normal N; vector V; vector xdir; float xroughness, yroughness)
{
    float sqr(float x) { return x * x; }
    float cos_theta_r = clamp(N . V, .0001, 1);
    vector X = xdir / xroughness;
    vector Y = (N ^ xdir) / yroughness;
    color C = 0;
    extern point P;
    illuminance (P, N, PI / 2) {
        extern vector L;
        extern color Cl;
        float nonspec = 0;
        lightsource("__nonspecular", nonspec);
        if (nonspec < 1) {
            vector LN = normalize(L);
            float cos_theta_i = LN . N;
            if (cos_theta_i > 0) {
                vector H = normalize(V + LN);
                float rho = exp(-2 * (sqr(X . H) + sqr(Y . H)) / (1 + H . N)) / sqrt(cos_theta_i * cos_theta_r);
                C += Cl * ((1 - nonspec) * cos_theta_i * rho);
            }
        }
    }
    return C / (4 * xroughness * yroughness);
}

#endif
