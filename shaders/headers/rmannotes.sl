/* SPDX-License-Identifier: Apache-2.0
 * The macros that shaders of the nineties include under this name.
 * Written for Perigee to the names that published shaders expect. */
#ifndef RMANNOTES_SL
#define RMANNOTES_SL 1

#include "filterwidth.h"

#define blend(a, b, x) ((a) * (1 - (x)) + (b) * (x))
#define union(a, b) ((a) + (b) - (a) * (b))
#define intersection(a, b) ((a) * (b))
#define difference(a, b) ((a) * (1 - (b)))
#define complement(a) (1 - (a))

#define boxstep(a, b, x) (clamp(((x) - (a)) / ((b) - (a)), 0, 1))
#define pulse(a, b, fuzz, x) (smoothstep((a) - (fuzz), (a), (x)) - smoothstep((b) - (fuzz), (b), (x)))
#define bias(b, x) (pow((x), log(b) / log(.5)))
#define gain(g, x) (((x) < .5) ? bias(1 - (g), 2 * (x)) / 2 : 1 - bias(1 - (g), 2 - 2 * (x)) / 2)
#define gammacorrect(gamma, x) (pow((x), 1 / (gamma)))

#define repeat(x, freq) (mod((x) * (freq), 1))
#define whichtile(x, freq) (floor((x) * (freq)))
#define odd(x) (mod((x), 2) == 1)
#define even(x) (mod((x), 2) == 0)

#define noisep(x) (noise(x))
#define snoise(x) (noise(x) * 2 - 1)
#define snoise2(x, y) (noise((x), (y)) * 2 - 1)
#define udn(x, lo, hi) (smoothstep(.25, .75, noise(x)) * ((hi) - (lo)) + (lo))
#define udn2(x, y, lo, hi) (smoothstep(.25, .75, noise((x), (y))) * ((hi) - (lo)) + (lo))

#define sqr(x) ((x) * (x))
#define deg(rad) degrees(rad)
#define rad(deg) radians(deg)

#define rotate2d(x, y, rad, ox, oy, rx, ry) \
    rx = ((x) - (ox)) * cos(rad) - ((y) - (oy)) * sin(rad) + (ox); \
    ry = ((x) - (ox)) * sin(rad) + ((y) - (oy)) * cos(rad) + (oy)

void topolar2d(float x, y; output float r, theta)
{
    r = sqrt(x * x + y * y);
    theta = atan(y, x);
}
#define topolar(x, y, r, theta) topolar2d(x, y, r, theta)

/* Distance from a segment of the plane. */
float ptlined2d(float px, py, ax, ay, bx, by)
{
    return ptlined(point (ax, ay, 0), point (bx, by, 0), point (px, py, 0));
}

#endif
