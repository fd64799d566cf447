// SPDX-License-Identifier: Apache-2.0
// rule: spline runs from the second knot at 0 to the last but one at 1, clamps its value, and knows the bases.
// spec: RI 3.2, Shading Language, spline
// scene: plate 8
// expect: [line for line in output if "wrong" in line][:3] == []
// expect: mean("out.tif") == vec(1, 1, 1, 1) +- 1e-6 | every check of every point held
#include "check.h"
surface splines()
{
    BEGIN_CHECKS
    float zero = s - s;
    CHECK("catmull-rom at 0", spline(zero, 9, 1, 3, 2, 7), 1, 1e-6)
    CHECK("catmull-rom at 1", spline(zero + 1, 9, 1, 3, 2, 7), 2, 1e-6)
    CHECK("below 0", spline(zero - 4, 9, 1, 3, 2, 7), 1, 1e-6)
    CHECK("above 1", spline(zero + 4, 9, 1, 3, 2, 7), 2, 1e-6)
    CHECK("catmull-rom knot", spline(zero + .5, 9, 1, 3, 2, 7), 3, 1e-6)
    CHECK("catmull-rom middle", spline(zero + .5, 0, 0, 1, 1), 0.5, 1e-6)
    CHECK("linear", spline("linear", zero + .25, 99, 0, 4, 99), 1, 1e-6)
    CHECK("bezier", spline("bezier", zero + .5, 0, 1, 1, 0), 0.75, 1e-6)
    CHECK("bezier end", spline("bezier", zero + 1, 0, 1, 1, 5), 5, 1e-6)
    CHECK("bspline", spline("bspline", zero, 0, 6, 0, 0), 4, 1e-6)
    CHECK("hermite", spline("hermite", zero + .5, 0, 0, 1, 0), 0.5, 1e-6)
    CHECK("solve", spline("solvelinear", zero + 1, 99, 0, 4, 99), 0.25, 1e-5)
    float knots[5] = {0, 0, 1, 4, 9};
    CHECK("array", spline(zero + .5, knots), 1, 1e-6)
    CHECK_COLOR("colours", spline(zero + 1, color(9, 9, 9), color(0, 0, 0), color(1, .5, .25), color(9, 9, 9)), color(1, .5, .25), 1e-6)
    END_CHECKS
}
