// SPDX-License-Identifier: Apache-2.0
// rule: concat, format, match and comparison of strings.
// spec: RI 3.2, Shading Language, String functions
// scene: plate 8
// expect: [line for line in output if "wrong" in line][:3] == []
// expect: mean("out.tif") == vec(1, 1, 1, 1) +- 1e-6 | every check of every point held
#include "check.h"
surface strings()
{
    BEGIN_CHECKS
    CHECK("concat", (concat("a", "b", "c") == "abc") ? 1 : 0, 1, 0)
    CHECK("format", (format("%d-%s", 7, "x") == "7-x") ? 1 : 0, 1, 0)
    CHECK("padded", (format("%04d", 42) == "0042") ? 1 : 0, 1, 0)
    CHECK("precision", (format("%.2f", .125) == "0.12" || format("%.2f", .125) == "0.13") ? 1 : 0, 1, 0)
    CHECK("match", match("b.*d", "abcd"), 1, 0)
    CHECK("match anchored", match("^b", "abcd"), 0, 0)
    CHECK("class", match("[0-9]$", "file7"), 1, 0)
    CHECK("not equal", ("a" != "b") ? 1 : 0, 1, 0)
    END_CHECKS
}
