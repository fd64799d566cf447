// SPDX-License-Identifier: Apache-2.0
// rule: step, smoothstep, clamp, min, max and mix, with their limits in the order of the specification.
// spec: RI 3.2, Shading Language, Mathematical functions
// scene: plate 8
// expect: [line for line in output if "wrong" in line][:3] == []
// expect: mean("out.tif") == vec(1, 1, 1, 1) +- 1e-6 | every check of every point held
#include "check.h"
surface steps()
{
    BEGIN_CHECKS
    float zero = s - s;
    CHECK("step below", step(zero + .5, .4999), 0, 0)
    CHECK("step at", step(zero + .5, .5), 1, 0)
    CHECK("smoothstep below", smoothstep(zero, 1, -1), 0, 0)
    CHECK("smoothstep 1/4", smoothstep(zero, 1, .25), 0.15625, 1e-6)
    CHECK("smoothstep above", smoothstep(zero, 1, 1), 1, 0)
    CHECK("smoothstep equal below", smoothstep(zero, 0, -.001), 0, 0)
    CHECK("smoothstep equal at", smoothstep(zero, 0, 0), 1, 0)
    CHECK("clamp", clamp(zero + 5, 0, 1), 1, 0)
    CHECK("clamp lo > hi", clamp(zero, 1, -1), 1, 0)
    CHECK("min of many", min(zero + 3, 1, 2), 1, 0)
    CHECK("max of many", max(zero, -1, 7, 2), 7, 0)
    CHECK("mix outside", mix(zero + 1, 3, 2), 5, 0)
    CHECK_COLOR("max of colours", max(color(1, 2, 3) + zero, color(3, 2, 1)), color(3, 2, 3), 0)
    CHECK_COLOR("clamp of colours", clamp(color(-1, .5, 2) + zero, color(0, 0, 0), color(1, 1, 1)), color(0, .5, 1), 0)
    CHECK_COLOR("mix of colours", mix(color(0, 1, 2) + zero, color(1, 1, 1), .5), color(.5, 1, 1.5), 1e-6)
    CHECK3("mix of points", mix(point(0, 0, 0) + vector(zero, 0, 0), point(2, 4, 6), .25), point(.5, 1, 1.5), 1e-6)
    END_CHECKS
}
