/* SPDX-License-Identifier: Apache-2.0
 * Benchmark: a brick wall whose edges are averaged over the sample's width. */
#define WIDTH_OF(x) max(abs(Du(x) * du) + abs(Dv(x) * dv), 1e-6)
/* Mean of the pulse that is 1 in [a, b] of every unit, over [x - w/2, x + w/2]. */
#define AREA_BELOW(x, a, b) ((b - a) * floor(x) + min(b - a, max(0, mod(x, 1) - a)))
#define MEAN_PULSE(a, b, x, w) ((AREA_BELOW(x + .5 * w, a, b) - AREA_BELOW(x - .5 * w, a, b)) / w)

surface brick(color clay = color(.6, .2, .13), mortar = color(.65, .65, .6);
              float length = .25, height = .08, gap = .01, Ka = .3, Kd = .7, stain = .4;)
{
    float column = s / (length + gap), row = t / (height + gap);
    float wide = WIDTH_OF(column), tall = WIDTH_OF(row);
    column += .5 * mod(floor(row), 2);
    uniform float gap_x = .5 * gap / (length + gap), gap_y = .5 * gap / (height + gap);
    float inside = MEAN_PULSE(gap_x, 1 - gap_x, column, wide) * MEAN_PULSE(gap_y, 1 - gap_y, row, tall);
    float shade = 1 - stain * cellnoise(floor(column), floor(row));
    normal Nf = faceforward(normalize(N), I);
    uniform vector to_light = normalize(vector(1, 2, -3));
    Oi = Os;
    Ci = Os * Cs * mix(mortar, clay * shade, inside) * (Ka + Kd * max(0, Nf . to_light));
}
