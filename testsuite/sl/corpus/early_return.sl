// SPDX-License-Identifier: Apache-2.0
/* Several returns, also from inside loops, and functions whose type is left to be found. */
float first_above(float limit)
{
    extern float s;
    float x;
    for (x = 0; x < 4; x += 1) {
        if (noise(x + s) > limit)
            return x;
    }
    return -1;
}
sign_word(float x) { if (x < 0) return "negative"; return "positive"; }
both(float a, b; output float lo, hi)
{
    if (a < b) { lo = a; hi = b; return; }
    lo = b;
    hi = a;
}
color shade(float k)
{
    if (k < 0) return (0, 0, 1);
    else if (k > 2) { return color (1, 0, 0); }
    else return k;
}
surface early_return(float limit = .6)
{
    float lo, hi;
    both(s, t, lo, hi);
    if (lo == hi) {
        Ci = 0;
        Oi = 0;
        return;
    }
    Ci = shade(first_above(limit)) * (hi - lo);
    if (sign_word(lo - limit) == "negative")
        Ci *= .5;
    Oi = 1;
}
