// SPDX-License-Identifier: Apache-2.0
/* Strokes that grow with darkness, in raster space, crossed in the deep shadow; wobble by noise. */
#define STROKE(x, freq, dark) (1 - smoothstep((dark) * .5, (dark) * .5 + .15, abs(mod((x) * (freq), 1) - .5)))
surface hatching(float freq = .12; color paper = color (1, .98, .9), ink = color (.1, .05, .2); float wobble = 1.5)
{
    normal Nf = faceforward(normalize(N), I);
    color d = diffuse(Nf) + ambient();
    float lum = .3 * comp(d, 0) + .6 * comp(d, 1) + .1 * comp(d, 2);
    float dark = clamp(1 - lum, 0, 1);
    point R = transform("raster", P);
    float x = xcomp(R) + wobble * noise(R * .05) * 4, y = ycomp(R) + wobble * noise(R * .06 + 10) * 4;
    float mark = STROKE(x + y, freq, dark);
    if (dark > .55)
        mark = max(mark, STROKE(x - y, freq, (dark - .55) * 2));
    Ci = mix(paper, ink, clamp(mark, 0, 1)) * Os;
    Oi = Os;
}
