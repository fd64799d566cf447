// SPDX-License-Identifier: Apache-2.0
/* Macros with local declarations, pasting, and a guard around parameters. */
#define PASTE(a, b) a##b
#define NAME(x) PASTE(x, _amount)
#define LAYER(c, k, mask)      \
    {                          \
        color layer = (c);     \
        float m = (mask);      \
        Ct = mix(Ct, layer, (k) * m); \
    }
#define PARAMS float NAME(first) = 1; float NAME(second) = .5
#define STR(x) #x
#if 0
this isn't SL, and the compiler shouldn't care
#elif defined PERIGEE && (PI_DIGITS + 0 < 3)
surface macros_deep(PARAMS; string label = STR(macros_deep);)
#endif
{
    color Ct = Cs;
    LAYER(color (1, 0, 0), first_amount, noise(s * 4))
    LAYER((0, 1, 0), second_amount, step(.5, t))
#pragma nolint 2
#ifndef PI
#define PI 3.14
#endif
    Ci = Ct * (label == "macros_deep" ? sin(PI * s) : 0);
    Oi = Os;
}
