/* SPDX-License-Identifier: Apache-2.0
 * Shaders whose filter widths come from area operators, or with CONSTANT_WIDTH are constants; PATTERN picks one
 * (area_bench.cpp).
 */
#define STRIPES 1
#define BRICKS  2
#define MARBLE  3
#define BUMPS   4
#define PLASTIC 5

#ifdef CONSTANT_WIDTH
#define WIDTH(x)       0.01
#define WIDTH_OF(p)    0.01
#define NORMAL_OF(p)   (p)
#else
#define WIDTH(x)       max(abs(Du(x) * du) + abs(Dv(x) * dv), 1e-6)
#define WIDTH_OF(p)    max(sqrt(area(p)), 1e-6)
#define NORMAL_OF(p)   calculatenormal(p)
#endif

float pulse(float lo, hi, x, w)
{
    return clamp((min(x + w / 2, hi) - max(x - w / 2, lo)) / w, 0, 1);
}

/* The highlight and diffuse term of one fixed light: what comes after the last area operator. */
color lit(color base; normal n; vector i)
{
    vector l = normalize(vector(1, 2, -3));
    vector h = normalize(l - normalize(i));
    return base * max(0, l . n) + 0.3 * pow(max(0, h . n), 20);
}

surface area_operators(float freq = 6;)
{
    normal Nn = normalize(N);
    color base = Cs;
#if PATTERN == STRIPES
    float x = s * freq;
    base = mix(Cs, color(1, 1, 1), pulse(0.3, 0.7, mod(x, 1), WIDTH(x)));
#elif PATTERN == BRICKS
    float tt = t * freq * 2, ss = s * freq;
    float ws = WIDTH(ss), wt = WIDTH(tt);
    if (mod(tt * 0.5, 1) > 0.5)
        ss += 0.5;
    float inside = pulse(0.1, 0.9, mod(ss, 1), ws) * pulse(0.15, 0.85, mod(tt, 1), wt);
    base = mix(color(0.8, 0.8, 0.8), Cs * (0.7 + 0.6 * noise(floor(ss), floor(tt))), inside);
#elif PATTERN == MARBLE
    float w = WIDTH_OF(P), f = 1, turb = 0, k;
    for (k = 0; k < 6; k += 1) {
        turb += abs(noise(P * f) - 0.5) / f * (1 - smoothstep(0.2, 0.7, w * f));
        f *= 2;
    }
    base = spline(clamp(2 * turb, 0, 1), Cs, Cs, color(.9, .9, .8), color(.2, .2, .3), Cs, Cs);
#elif PATTERN == BUMPS
    float f = 1, h = 0, k;
    for (k = 0; k < 4; k += 1) {
        h += noise(P * f) / f;
        f *= 2;
    }
    Nn = normalize(normal(NORMAL_OF(P + 0.1 * h * Nn)));
#else
    float x = s * freq, y = t * freq, k, f = 1, turb = 0;
    float spots = smoothstep(0.4, 0.4 + WIDTH(x) + WIDTH(y), noise(x, y));
    for (k = 0; k < 4; k += 1) {
        turb += noise(P * f) / f;
        f *= 2;
    }
    base = mix(Cs, color(turb, turb, 1), spots);
#endif
    Oi = Os;
    Ci = Os * lit(base, Nn, I);
}
