// SPDX-License-Identifier: Apache-2.0
// rule: depth() is linear from the near to the far clipping plane.
// spec: RI 3.2, Shading Language, Geometric functions
// scene: plate 8
// expect: [line for line in output if "wrong" in line][:3] == []
// expect: mean("out.tif") == vec(1, 1, 1, 1) +- 1e-6 | every check of every point held
#include "check.h"
surface depths()
{
    BEGIN_CHECKS
    CHECK("depth", depth(P), (zcomp(transform("camera", P)) - .5) / (4.5 - .5), 1e-5)
    CHECK("not a constant", step(.3, depth(P)) * step(depth(P), .4), 1, 0)
    END_CHECKS
}
