// SPDX-License-Identifier: Apache-2.0
// rule: pnoise repeats with its period, rounded to an integer of at least 1.
// spec: RI 3.2, Shading Language, pnoise
// scene: plate 8
// expect: [line for line in output if "wrong" in line][:3] == []
// expect: mean("out.tif") == vec(1, 1, 1, 1) +- 1e-6 | every check of every point held
#include "check.h"
surface pnoise_rules()
{
    BEGIN_CHECKS
    float zero = s - s;
    CHECK("1-D", pnoise(zero + 1.3, 4), pnoise(zero + 5.3, 4), 1e-5)
    CHECK("2-D", pnoise(zero + 1.3, .4, 4, 3), pnoise(zero - 2.7, 3.4, 4, 3), 1e-5)
    CHECK("3-D", pnoise(point(.3 + zero, .4, .6), point(2, 3, 5)), pnoise(point(2.3, -2.6, 5.6), point(2, 3, 5)), 1e-5)
    CHECK("period below 1", pnoise(zero + .3, .2), pnoise(zero + 4.3, .2), 1e-5)
    CHECK("lattice", pnoise(zero + 2, 4), .5, 1e-6)
    END_CHECKS
}
