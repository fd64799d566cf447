// SPDX-License-Identifier: Apache-2.0
// rule: Arrays of each type, indexed by uniform and varying expressions.
// spec: RI 3.2, Shading Language, Types
// scene: plate 8
// expect: [line for line in output if "wrong" in line][:3] == []
// expect: mean("out.tif") == vec(1, 1, 1, 1) +- 1e-6 | every check of every point held
#include "check.h"
surface arrays()
{
    BEGIN_CHECKS
    float table[4] = {1, 2, 4, 8};
    color paint[2] = {color(1, 0, 0), color(0, 1, 0)};
    float i = floor(s * 3.99), sum = 0;
    uniform float j;
    CHECK("varying index", table[i], pow(2, i), 1e-5)
    for (j = 0; j < 4; j += 1)
        sum += table[j];
    CHECK("sum", sum, 15, 0)
    table[i] = 99;
    CHECK("varying store", table[i], 99, 0)
    CHECK("others kept", table[mod(i + 1, 4)], pow(2, mod(i + 1, 4)), 1e-5)
    CHECK_COLOR("colours", paint[1], color(0, 1, 0), 0)
    CHECK("arraylength", arraylength(table), 4, 0)
    END_CHECKS
}
