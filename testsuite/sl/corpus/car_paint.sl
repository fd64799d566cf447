// SPDX-License-Identifier: Apache-2.0
/* Metallic lacquer: flakes that tilt the normal, colour by angle, clear coat with fresnel reflection. */
#include "material.h"
surface car_paint(float Ka = 1, Kd = .6, Ks = .5, roughness = .15, Kr = .5, ior = 1.5, flakefreq = 60, flaketilt = .25;
                  color edgecolor = color (.05, .0, .25); DECLARE_DEFAULTED_ENVPARAMS;)
{
    normal Nf = faceforward(normalize(N), I);
    vector V = -normalize(I), IN = normalize(I);
    point Q = transform("shader", P) * flakefreq;
    vector tilt = vector cellnoise(Q) - .5;
    normal Nflake = normalize(Nf + flaketilt * vtransform("shader", "current", tilt));
    float facing = clamp(Nf . V, 0, 1);
    color base = mix(edgecolor, Cs, pow(facing, 1.5));
    color flakes = specular(Nflake, V, roughness) * base;
    float kr, kt;
    vector R, T;
    fresnel(IN, Nf, (I . N < 0) ? 1 / ior : ior, kr, kt, R, T);
    kt = 1 - kr;
    Oi = Os;
    Ci = Oi * (kt * (base * (Ka * ambient() + Kd * diffuse(Nf)) + flakes) + Ks * specular(Nf, V, .02)
               + SampleEnvironment(P, R, Kr * kr, 0, ENVPARAMS));
}
