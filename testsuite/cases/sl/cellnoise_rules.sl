// SPDX-License-Identifier: Apache-2.0
// rule: cellnoise is constant in each integer cell, negative ones too, uniform in 0..1 over the cells.
// spec: RI 3.2, Shading Language, cellnoise
// scene: plate 8
// expect: [line for line in output if "wrong" in line][:3] == []
// expect: mean("out.tif") == vec(1, 1, 1, 1) +- 1e-6 | every check of every point held
#include "check.h"
surface cellnoise_rules()
{
    BEGIN_CHECKS
    float zero = s - s, sum = 0, squares = 0;
    float i;
    CHECK("one cell", cellnoise(zero + 3.01), cellnoise(zero + 3.99), 0)
    CHECK("a negative cell", cellnoise(zero - .01), cellnoise(zero - .99), 0)
    CHECK("across 0", step(1e-7, abs(cellnoise(zero - .5) - cellnoise(zero + .5))), 1, 0)
    CHECK("3-D cell", cellnoise(point(1.1, -2.9, 3.5) + vector(zero, 0, 0)), cellnoise(point(1.9, -2.1, 3.1)), 0)
    for (i = 0; i < 3000; i += 1) {
        float n = cellnoise(i + .5 + zero, floor(i / 50) + .5);
        sum += n;
        squares += n * n;
    }
    // Standard errors: 0.0053 and 0.0054.
    CHECK("mean", sum / 3000, .5, .025)
    CHECK("mean square", squares / 3000, 1 / 3, .025)
    END_CHECKS
}
