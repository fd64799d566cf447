// SPDX-License-Identifier: Apache-2.0
/* Continents, ice and clouds of a planet: fractal altitude, a spline of colours by latitude and height, sea that shines. */
#include "noises.h"
surface planet_earth(float Ka = .1, Kd = .9, Ks = .3, roughness = .1, spectral_exp = .6, lacunarity = 2.2, octaves = 7, sea = -.05, snow = .75;
                     color deep = color (.03, .1, .3), shallow = color (.1, .3, .5))
{
    point Psh = transform("shader", P);
    float w = filterwidthp(Psh);
    uniform float gain = pow(lacunarity, -spectral_exp);
    float alt = fBm(Psh * 1.5, w * 1.5, octaves, lacunarity, gain);
    float latitude = abs(ycomp(normalize(vector Psh)));
    color land = spline(clamp(alt * 1.5 + .3 * latitude, 0, 1), color (.2, .4, .1), color (.2, .4, .1), color (.3, .45, .15), color (.5, .45, .25),
                        color (.45, .35, .25), color (.8, .8, .8), color (1, 1, 1));
    float icy = smoothstep(snow, snow + .1, latitude + .2 * alt);
    color water = mix(deep, shallow, smoothstep(-.4, sea, alt));
    float ground = smoothstep(sea, sea + .02, alt);
    color Ct = mix(mix(water, land, ground), color 1, icy);
    float clouds = smoothstep(.1, .6, turbulence(Psh * 2 + .3 * vfBm(Psh * 2, w * 2, 3, 2, .5), w * 2, 6, 2, .5) - .2);
    Ct = mix(Ct, color 1, clouds);
    normal Nf = faceforward(normalize(N), I);
    Oi = Os;
    Ci = Os * (Ct * (Ka * ambient() + Kd * diffuse(Nf)) + (1 - ground) * (1 - clouds) * Ks * specular(Nf, -normalize(I), roughness));
}
