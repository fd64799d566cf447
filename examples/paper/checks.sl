// SPDX-License-Identifier: Apache-2.0
// Two colors in squares, filtered over the shading sample; part of what is around is seen in them.
surface checks(float Ka = 1, Kd = .8, Kr = .15, columns = 12, rows = 12; color other = color(.12, .1, .1);)
{
    normal Nf = faceforward(normalize(N), I);
    float ws = max(abs(Du(s * columns) * du) + abs(Dv(s * columns) * dv), 1e-6);
    float wt = max(abs(Du(t * rows) * du) + abs(Dv(t * rows) * dv), 1e-6);
    // The integral of the square wave over the width of a sample.
    float a = s * columns - .5 * ws, b = t * rows - .5 * wt;
    float square_s = ((floor(.5 * (a + ws)) + 2 * max(.5 * (a + ws) - floor(.5 * (a + ws)) - .5, 0)) -
                      (floor(.5 * a) + 2 * max(.5 * a - floor(.5 * a) - .5, 0))) / ws;
    float square_t = ((floor(.5 * (b + wt)) + 2 * max(.5 * (b + wt) - floor(.5 * (b + wt)) - .5, 0)) -
                      (floor(.5 * b) + 2 * max(.5 * b - floor(.5 * b) - .5, 0))) / wt;
    float odd = square_s * (1 - square_t) + square_t * (1 - square_s);
    color tile = mix(Cs, other, odd);
    color shine = 0;
    if (Kr > 0)
        shine = Kr * color trace(P, reflect(normalize(I), Nf));
    Oi = Os;
    Ci = Os * (tile * (Ka * ambient() + Kd * diffuse(Nf)) + shine);
}
