// SPDX-License-Identifier: Apache-2.0
// rule: Functions of DSOs in directories the user names are called by their overloads, with outputs, strings and state of
//   their own, under any mask.
// spec: docs/shadeops.md
// scene: plate 8
// run: render -shadeops {build}/runtime/base/test {scene}
// quiet: dsobroken
// expect: [line for line in output if "wrong" in line][:3] == []
// expect: mean("out.tif") == vec(1, 1, 1, 1) +- 1e-6 | every check of every point held
#include "check.h"
surface called()
{
    BEGIN_CHECKS
    float squared = -1, masked = -1;
    color c = color(u, v, 0);
    string text = "";
    CHECK("float", dsosum(u, 2), u + 2, 1e-6)
    c = dsosum(c, color(1, 2, 3));
    CHECK_COLOR("color", c, color(u + 1, v + 2, 3), 1e-6)
    point turned = dsoturn(point (u, v, 1), squared);
    CHECK3("point", turned, point (-v, u, 1), 1e-6)
    CHECK("output", squared, u * u + v * v + 1, 1e-6)
    dsolabel("row", floor(8 * v), text);
    CHECK("string", (text == format("row%d", floor(8 * v))) ? 1 : 0, 1, 0)
    CHECK("older form", dsoscale(u, 3), 3 * u, 1e-6)
    CHECK_COLOR("older form, color", dsoscale(color(1, u, v), 2), 2 * color(1, u, v), 1e-6)
    if (u < .5)
        masked = dsosum(10, u);
    CHECK("only there", masked, (u < .5) ? 10 + u : -1, 1e-6)
    END_CHECKS
}
