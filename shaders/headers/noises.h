/* SPDX-License-Identifier: Apache-2.0
 * Signed noise and its sums. Filtered forms fade to their mean where the filter width nears the size of the features.
 * Written for Perigee to the names that published shaders expect. */
#ifndef NOISES_H
#define NOISES_H 1

#include "filterwidth.h"

#define snoise(x) (2 * (float noise(x)) - 1)
#define snoise2(x, y) (2 * (float noise((x), (y))) - 1)
#define snoisexy(x, y) (2 * (float noise((x), (y))) - 1)
#define vsnoise(p) (2 * (vector noise(p)) - 1)
#define csnoise(p) (2 * (color noise(p)) - 1)
#define snoisept(p, t) (2 * (float noise((p), (t))) - 1)
#define vsnoisept(p, t) (2 * (vector noise((p), (t))) - 1)

#define fadeout(g, g_avg, featuresize, fwidth) mix(g, g_avg, smoothstep(.2, .6, (fwidth) / (featuresize)))
#define filterednoise(p, w) fadeout(noise(p), .5, 1, w)
#define filteredsnoise(p, w) fadeout(snoise(p), 0, 1, w)
#define filteredvsnoise(p, w) fadeout(vsnoise(p), vector 0, 1, w)
#define filteredsnoisept(p, t, w) fadeout(snoisept(p, t), 0, 1, w)

/* A sum of octaves of signed noise; those smaller than the filter are left out. */
float fBm(point p; float filtwidth; uniform float maxoctaves, lacunarity, gain)
{
    uniform float i;
    uniform float amp = 1;
    varying point pp = p;
    varying float sum = 0, fw = filtwidth;
    for (i = 0; i < maxoctaves; i += 1) {
        sum += amp * filteredsnoise(pp, fw);
        amp *= gain;
        pp *= lacunarity;
        fw *= lacunarity;
    }
    return sum;
}

vector vfBm(point p; float filtwidth; uniform float maxoctaves, lacunarity, gain)
{
    uniform float i;
    uniform float amp = 1;
    varying point pp = p;
    varying vector sum = 0;
    varying float fw = filtwidth;
    for (i = 0; i < maxoctaves; i += 1) {
        sum += amp * filteredvsnoise(pp, fw);
        amp *= gain;
        pp *= lacunarity;
        fw *= lacunarity;
    }
    return sum;
}

/* The same with the absolute value of the noise: sharp valleys. */
float turbulence(point p; float filtwidth; uniform float maxoctaves, lacunarity, gain)
{
    uniform float i;
    uniform float amp = 1;
    varying point pp = p;
    varying float sum = 0, fw = filtwidth;
    for (i = 0; i < maxoctaves; i += 1) {
        varying float n = abs(filteredsnoise(pp, fw));
        sum += amp * n;
        amp *= gain;
        pp *= lacunarity;
        fw *= lacunarity;
    }
    return sum;
}

/* Noise of noise: the lattice is distorted by `scale`. */
float VLNoise(point p; float scale)
{
    vector offset = vsnoise(p + vector (.5, .5, .5));
    return snoise(p + scale * offset);
}

float filteredVLNoise(point p; float filtwidth; float scale)
{
    return fadeout(VLNoise(p, scale), 0, 1, filtwidth);
}

float VLfBm(point p; float filtwidth; uniform float maxoctaves, lacunarity, gain, scale)
{
    uniform float i;
    uniform float amp = 1;
    varying point pp = p;
    varying float sum = 0, fw = filtwidth;
    for (i = 0; i < maxoctaves; i += 1) {
        sum += amp * filteredVLNoise(pp, fw, scale);
        amp *= gain;
        pp *= lacunarity;
        fw *= lacunarity;
    }
    return sum;
}

#define fBm_default(p) fBm(p, filterwidthp(p), 4, 2, .5)
#define vfBm_default(p) vfBm(p, filterwidthp(p), 4, 2, .5)
#define turbulence_default(p) turbulence(p, filterwidthp(p), 4, 2, .5)
#define VLfBm_default(p) VLfBm(p, filterwidthp(p), 4, 2, .5, 1)

#endif
