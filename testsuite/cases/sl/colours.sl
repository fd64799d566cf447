// SPDX-License-Identifier: Apache-2.0
// rule: Colour spaces convert by the formulas of the specification; comp and setcomp reach the channels.
// spec: RI 3.2, Shading Language, Color functions
// scene: plate 8
// expect: [line for line in output if "wrong" in line][:3] == []
// expect: mean("out.tif") == vec(1, 1, 1, 1) +- 1e-6 | every check of every point held
#include "check.h"
surface colours()
{
    BEGIN_CHECKS
    float zero = s - s;
    color red = color(1 + zero, 0, 0);
    CHECK_COLOR("hsv", ctransform("hsv", red), color(0, 1, 1), 1e-6)
    CHECK_COLOR("hsv green", color "hsv" (1 / 3 + zero, 1, .5), color(0, .5, 0), 1e-5)
    CHECK_COLOR("hue wraps", color "hsv" (4 / 3 + zero, 1, .5), color(0, .5, 0), 1e-5)
    CHECK_COLOR("hsl", color "hsl" (2 / 3 + zero, 1, .5), color(0, 0, 1), 1e-5)
    CHECK_COLOR("hsl grey", ctransform("hsl", color(.25, .25, .25) + zero), color(0, 0, .25), 1e-6)
    CHECK_COLOR("YIQ", ctransform("YIQ", red), color(.299, .596, .212), 1e-5)
    CHECK_COLOR("xyz and back", ctransform("xyz", "rgb", ctransform("xyz", color(.2, .5, .7) + zero)), color(.2, .5, .7), 1e-4)
    CHECK_COLOR("xyY and back", ctransform("xyY", "rgb", ctransform("xyY", color(.2, .5, .7) + zero)), color(.2, .5, .7), 1e-4)
    CHECK_COLOR("hsv and back", ctransform("hsv", "rgb", ctransform("hsv", color(.2, .5, .7) + zero)), color(.2, .5, .7), 1e-5)
    CHECK("comp", comp(color(1, 2, 3) + zero, 1), 2, 0)
    color c = color(1, 2, 3) + zero;
    setcomp(c, 2, 9);
    CHECK_COLOR("setcomp", c, color(1, 2, 9), 0)
    CHECK_COLOR("product", color(1, 2, 3) * color(2, 2, 2 + zero), color(2, 4, 6), 0)
    CHECK_COLOR("spread", color(1, 2, 3) * (2 + zero), color(2, 4, 6), 0)
    END_CHECKS
}
