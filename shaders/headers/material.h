/* SPDX-License-Identifier: Apache-2.0
 * Materials as functions, to be laid over each other: base colour in, light towards the viewer out.
 * Written for Perigee to the names that published shaders expect. */
#ifndef MATERIAL_H
#define MATERIAL_H 1

#include "locillum.h"
#include "reflections.h"

color MaterialMatte(normal Nf; color basecolor; float Ka, Kd)
{
    return basecolor * (Ka * ambient() + Kd * diffuse(Nf));
}

color MaterialRoughMetal(normal Nf; color basecolor; float Ka, Kd, Ks, roughness)
{
    extern vector I;
    vector V = -normalize(I);
    return basecolor * (Ka * ambient() + Kd * diffuse(Nf) + Ks * specular(Nf, V, roughness));
}

color MaterialPlastic(normal Nf; color basecolor; float Ka, Kd, Ks, roughness)
{
    extern vector I;
    vector V = -normalize(I);
    return basecolor * (Ka * ambient() + Kd * diffuse(Nf)) + Ks * specular(Nf, V, roughness);
}

color MaterialShinyMetal(normal Nf; color basecolor; float Ka, Kd, Ks, roughness, Kr, blur; DECLARE_ENVPARAMS)
{
    extern point P;
    extern vector I;
    vector IN = normalize(I), V = -IN;
    vector R = reflect(IN, Nf);
    return basecolor * (Ka * ambient() + Kd * diffuse(Nf) + Ks * specular(Nf, V, roughness)
                        + SampleEnvironment(P, R, Kr, blur, ENVPARAMS));
}

color MaterialShinyPlastic(normal Nf; color basecolor; float Ka, Kd, Ks, roughness, Kr, blur, ior; DECLARE_ENVPARAMS)
{
    extern point P;
    extern vector I;
    extern normal N;
    vector IN = normalize(I), V = -IN;
    float fkr, fkt;
    vector R, T;
    fresnel(IN, Nf, (I . N > 0) ? ior : 1 / ior, fkr, fkt, R, T);
    fkt = 1 - fkr;
    return fkt * basecolor * (Ka * ambient() + Kd * diffuse(Nf)) + (Ks * fkr) * specular(Nf, V, roughness)
        + SampleEnvironment(P, R, fkr * Kr, blur, ENVPARAMS);
}

color MaterialClay(normal Nf; color basecolor; float Ka, Kd, roughness)
{
    extern vector I;
    vector V = -normalize(I);
    return basecolor * (Ka * ambient() + Kd * LocIllumOrenNayar(Nf, V, roughness));
}

color MaterialBrushedMetal(normal Nf; color basecolor; vector xdir; float Ka, Kd, Ks, xroughness, yroughness)
{
    extern vector I;
    vector V = -normalize(I);
    return basecolor * (Ka * ambient() + Kd * diffuse(Nf)
                        + Ks * LocIllumWardAnisotropic(Nf, V, xdir, xroughness, yroughness));
}

color MaterialCeramic(normal Nf; color basecolor; float Ka, Kd, Ks, roughness, specsharpness)
{
    extern vector I;
    vector V = -normalize(I);
    return basecolor * (Ka * ambient() + Kd * diffuse(Nf)) + Ks * LocIllumGlossy(Nf, V, roughness, specsharpness);
}

#endif
