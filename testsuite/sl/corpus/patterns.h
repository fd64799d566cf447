/* Helpers shared by the corpus: macros and functions in the style of published headers. */
#ifndef PATTERNS_H
#define PATTERNS_H

#define snoise(x) (2 * noise(x) - 1)
#define snoise2(x, y) (2 * noise((x), (y)) - 1)
#define vsnoise(p) (2 * (vector noise(p)) - 1)
#define boxstep(a, b, x) clamp(((x) - (a)) / ((b) - (a)), 0, 1)
#define MINFILTWIDTH 1.0e-6
#define filterwidth(x) max(abs(Du(x) * du) + abs(Dv(x) * dv), MINFILTWIDTH)
#define filterwidthp(p) max(sqrt(area(p)), MINFILTWIDTH)
#define sqr(x) ((x) * (x))
#define blend(a, b, x) ((a) * (1 - (x)) + (b) * (x))
#define DECLARE_FRACTAL                                  \
    uniform float octaves = 5;                           \
    float lacunarity = 2; float gain = .5;
#define REPEATED(x, freq) mod((x) * (freq), 1)

float
pulse_train(float edge, period, x)
{
    return step(edge, mod(x, period));
}

float
filtered_pulse(float edge0, edge1, x, dx)
{
    float x0 = x - dx / 2;
    float x1 = x0 + dx;
    return max(0, (min(x1, edge1) - max(x0, edge0)) / dx);
}

float fractal(point p; float filtwidth; uniform float maxoctaves, lacunarity, gain)
{
    uniform float i;
    uniform float amp = 1;
    varying point pp = p;
    varying float sum = 0, fw = filtwidth;
    for (i = 0; i < maxoctaves; i += 1) {
        sum += amp * snoise(pp) * (1 - smoothstep(.2, .6, fw));
        amp *= gain; pp *= lacunarity; fw *= lacunarity;
    }
    return sum;
}

void rotate_2d(float x, y, angle, ox, oy; output float rx, ry)
{
    float sx = x - ox, sy = y - oy;
    float c = cos(angle), s = sin(angle);
    rx = sx * c - sy * s + ox;
    ry = sx * s + sy * c + oy;
}
#endif
