// SPDX-License-Identifier: Apache-2.0
// A plate below a stained one (at distance 1) and an opaque one (at distance 3): what visibility() and transmission() say.
#include "check.h"
surface transmission_functions()
{
    BEGIN_CHECKS
    color c = visibility(P, P + vector(0, 0, -.5));
    CHECK("open", comp(c, 0), 1, 0)
    c = transmission(P, P + vector(0, 0, -1.5));
    CHECK("red", comp(c, 0), .75, 1e-6)
    CHECK("green", comp(c, 1), .5, 1e-6)
    c = transmission(P, P + vector(0, 0, -3.5));
    CHECK("blocked", comp(c, 0), 0, 0)
    c = transmission(P + vector(0, 0, -1.5), P);
    CHECK("back", comp(c, 2), .25, 1e-6)
    c = transmission(P, P + vector(0, 0, -1.5), "hitmode", "opaque");
    CHECK("hitmode", comp(c, 0), 0, 0)
    END_CHECKS
}
