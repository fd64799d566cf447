/* SPDX-License-Identifier: Apache-2.0
 * Pulses, ramps, tilings and plane geometry, hard, smooth and filtered.
 * Written for Perigee to the names that published shaders expect. */
#ifndef PATTERNS_H
#define PATTERNS_H 1

#include "filterwidth.h"

#define boxstep(a, b, x) (clamp(((x) - (a)) / ((b) - (a)), 0, 1))
#define blend(a, b, x) ((a) * (1 - (x)) + (b) * (x))
#define union(a, b) ((a) + (b) - (a) * (b))
#define intersection(a, b) ((a) * (b))
#define difference(a, b) ((a) * (1 - (b)))
#define complement(a) (1 - (a))
#define repeat(x, freq) (mod((x) * (freq), 1))
#define whichtile(x, freq) (floor((x) * (freq)))
#define odd(x) (mod((x), 2) == 1)
#define even(x) (mod((x), 2) == 0)

/* Schlick's ramps. */
float bias(varying float value, b)
{
    return (b > 0) ? pow(value, log(b) / log(.5)) : 0;
}

float gain(float value, g)
{
    return .5 * ((value < .5) ? bias(2 * value, 1 - g) : (2 - bias(2 - 2 * value, 1 - g)));
}

/* Step from 0 to 1 between the edges, filtered over dx around x. */
float filteredstep(float edge, x, dx)
{
    return clamp((x + dx / 2 - edge) / dx, 0, 1);
}

float filteredsmoothstep(float edge0, edge1, x, dx)
{
    float integral(float t) { return -.5 * t * t * (t * t - 2 * t); }
    float ramp(float edge0, edge1, x)
    {
        float k = (x - edge0) / (edge1 - edge0), c = clamp(k, 0, 1);
        return (edge1 - edge0) * integral(c) + max(x - edge1, 0);
    }
    return (ramp(edge0, edge1, x + dx / 2) - ramp(edge0, edge1, x - dx / 2)) / dx;
}

float filteredabs(float x, dx)
{
    float integral(float t) { return sign(t) * .5 * t * t; }
    float x0 = x - .5 * dx;
    float x1 = x0 + dx;
    return (integral(x1) - integral(x0)) / dx;
}

/* 1 between the edges. */
float pulse(float edge0, edge1, x)
{
    return step(edge0, x) - step(edge1, x);
}

float filteredpulse(float edge0, edge1, x, dx)
{
    float x0 = x - dx / 2;
    float x1 = x0 + dx;
    return max(0, (min(x1, edge1) - max(x0, edge0)) / dx);
}

float smoothpulse(float edge0, edge1, edge2, edge3, x)
{
    return smoothstep(edge0, edge1, x) - smoothstep(edge2, edge3, x);
}

/* 0 up to `edge` of each period, 1 for the rest of it. */
float pulsetrain(float edge, period, x)
{
    return pulse(edge, period, mod(x, period));
}

float filteredpulsetrain(float edge, period, x, dx)
{
    float w = dx / period;
    float x0 = x / period - w / 2;
    float x1 = x0 + w;
    float nedge = edge / period;
    float integral(float t)
    {
        extern float nedge;
        return (1 - nedge) * floor(t) + max(0, t - floor(t) - nedge);
    }
    return (integral(x1) - integral(x0)) / w;
}

float smoothpulsetrain(float edge0, edge1, edge2, edge3, period, x)
{
    return smoothpulse(edge0, edge1, edge2, edge3, mod(x, period));
}

/* A different colour per tile, by hue, saturation and lightness. */
color varyEach(color Cin; float index, varyhue, varysat, varylum)
{
    color Chsl = ctransform("hsl", Cin);
    float h = comp(Chsl, 0), sat = comp(Chsl, 1), l = comp(Chsl, 2);
    h += varyhue * (cellnoise(index + 3) - .5);
    sat *= 1 - varysat * (cellnoise(index - 14) - .5);
    l *= 1 - varylum * (cellnoise(index + 37) - .5);
    Chsl = color (mod(h, 1), sat, l);
    return ctransform("hsl", "rgb", clamp(Chsl, color 0, color 1));
}

void rotate2d(float x, y, rad, ox, oy; output float rx, ry)
{
    float sx = x - ox, sy = y - oy;
    float cosa = cos(rad), sina = sin(rad);
    rx = sx * cosa - sy * sina + ox;
    ry = sx * sina + sy * cosa + oy;
}

void topolar(float x, y; output float r, theta)
{
    r = sqrt(x * x + y * y);
    theta = atan(y, x);
}

#endif
