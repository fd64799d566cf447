// SPDX-License-Identifier: Apache-2.0
// Overloads of built-in and user functions, and the types that calls take from their context.
float luminance(color c) { return .2 * comp(c, 0) + .7 * comp(c, 1) + .1 * comp(c, 2); }
float size(float x) { return abs(x); }
float size(vector v) { return length(v); }
float size(color c) { return luminance(c); }
float raylevel() { return 0; } /* hides the built-in */
surface overloads(color c1 = (1, 0, 0), c2 = (0, 1, 0); float k = .5)
{
    color C = noise(P);
    color G = noise(P) * color (1, 1, 1);
    point Q = random();
    vector v = (0, 0, 1), w = noise(s, t);
    float n = noise(P), pn = pnoise(P, point (4, 4, 4)) + pnoise(s, 3);
    color lo = clamp(C, color 0, color 1), hi = max(0, C);
    color m3 = mix(c1, c2, c1), m1 = mix(c1, c2, k);
    point pm = mix(P, Q, k);
    color sp = spline(k, c1, c1, c2, G, (0, 0, 1), c2);
    float fs = spline("bezier", k, 0, .2, .6, 1), inv = spline("solvelinear", k, 0, 0, 1, 1);
    vector r = rotate(v, PI / 2, point (0, 0, 0), point (1, 0, 0));
    matrix mx = rotate(matrix 1, PI, (0, 1, 0));
    if (C == G || raylevel() > 0)
        lo = hi;
    Ci = lo * (size(n) + size(w ^ r) + size(m3) + size(m1)) + sp * fs * inv + pn;
    Ci += color (vector transform(mx, pm) * determinant(1 / mx));
    Oi = 1;
}
