// SPDX-License-Identifier: Apache-2.0
/* Crossed ridges under a smooth band; the same displacement for true and bump use through a library function. */
#include "displace.h"
#include "patterns.h"
displacement knurled_grip(float Km = .03, freq = 24, lo = .3, hi = .7, truedisp = 1; string shadingspace = "shader";)
{
    float a = abs(mod((s + t * .5) * freq, 1) - .5), b = abs(mod((s - t * .5) * freq, 1) - .5);
    float band = smoothpulse(lo - .05, lo, hi, hi + .05, t);
    float amp = Km * band * (1 - min(a, b) * 2);
    N = Displace(normalize(N), shadingspace, amp, truedisp);
}
