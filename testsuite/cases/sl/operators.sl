// SPDX-License-Identifier: Apache-2.0
// rule: Precedence, triples by component, unary minus, comparison and logic.
// spec: RI 3.2, Shading Language, Expressions
// scene: plate 8
// expect: [line for line in output if "wrong" in line][:3] == []
// expect: mean("out.tif") == vec(1, 1, 1, 1) +- 1e-6 | every check of every point held
#include "check.h"
surface operators()
{
    BEGIN_CHECKS
    float zero = s - s;
    CHECK("precedence", 2 + 3 * 4 - 6 / 3 + zero, 12, 0)
    CHECK("minus binds first", -vector(1 + zero, 2, 3) . vector(1, 1, 1), -6, 0)
    CHECK("dot before product", 2 * vector(1 + zero, 0, 0) . vector(3, 0, 0), 6, 0)
    CHECK3("by component", vector(2 + zero, 4, 6) / vector(2, 2, 2), vector(1, 2, 3), 0)
    CHECK3("float spreads", vector(1 + zero, 2, 3) + 1, vector(2, 3, 4), 0)
    CHECK("logic", (1 < 2 && !(2 < 1 + zero)) ? 1 : 0, 1, 0)
    CHECK("equality of triples", (point(1, 2, 3) + vector(zero, 0, 0) == point(1, 2, 3)) ? 1 : 0, 1, 0)
    float a = 10;
    a += 2; a -= 4; a *= 3; a /= 6;
    CHECK("assignment operators", a + zero, 4, 0)
    CHECK("conditional", (zero == 0) ? 5 : 6, 5, 0)
    END_CHECKS
}
