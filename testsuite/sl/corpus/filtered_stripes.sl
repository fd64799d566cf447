// SPDX-License-Identifier: Apache-2.0
// Filtered patterns through macros that take derivatives.
#include "patterns.slh"
surface filtered_stripes(float freq = 10, duty = .5; color a = color "rgb" (1, 1, 1), b = color "hsl" (0.6, 1, .3);)
{
    float ss = REPEATED(s, freq);
    float dss = filterwidth(s * freq);
    float on = filtered_pulse(.5 - duty / 2, .5 + duty / 2, ss, dss);
    float edge = filterstep(.5, t) * filterstep(.2, t, t + dss);
    color C = blend(a, b, on) * (1 - edge * pulse_train(.5, 1, ss));
    Oi = Os;
    Ci = Oi * C * boxstep(0, 1, dss) + filterwidthp(P) * 0;
}
