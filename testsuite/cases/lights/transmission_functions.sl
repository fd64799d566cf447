// SPDX-License-Identifier: Apache-2.0
// rule: visibility() and transmission() give the colour of light that passes between two points; opaque things, layers
//   and ends count as for shadows.
// spec: BMRT manual, visibility(); PRMan's transmission()
// run: render {cases}/lights/transmission_scene.rib
// expect: [line for line in output if "wrong" in line][:3] == []
// expect: mean("out.tif") == vec(1, 1, 1, 1) +- 1e-6 | every check of every point held
#include "check.h"
surface transmission_functions()
{
    BEGIN_CHECKS
    CHECK("open", comp(visibility(P, P + vector "world" (0, 0, -.5)), 0), 1, 0)
    color c = transmission(P, P + vector(0, 0, -1.5));
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
