// SPDX-License-Identifier: Apache-2.0
// rule: Loops, break, continue and branches, uniform and varying, do for each point what a scalar machine would.
// spec: RI 3.2, Shading Language, Statements
// scene: plate 8
// expect: [line for line in output if "wrong" in line][:3] == []
// expect: mean("out.tif") == vec(1, 1, 1, 1) +- 1e-6 | every check of every point held
#include "check.h"
surface control_flow()
{
    BEGIN_CHECKS
    float i, j, n = floor(s * 8), sum = 0;
    for (i = 0; i < n; i += 1)
        sum += i;
    CHECK("varying count", sum, n * (n - 1) / 2, 0)
    sum = 0;
    for (i = 0; i < 100; i += 1) {
        if (i >= n)
            break;
        if (mod(i, 2) == 1)
            continue;
        sum += i;
    }
    float half = floor((n + 1) / 2);
    CHECK("break and continue", sum, half * (half - 1), 0)
    sum = 0;
    for (i = 0; i < 4; i += 1) {
        for (j = 0; j < 9; j += 1) {
            if (j > i + n)
                break 2;
            sum += 1;
        }
    }
    float wanted = 0, stop = 0;
    for (i = 0; i < 4; i += 1)
        for (j = 0; j < 9; j += 1) {
            if (stop == 0 && j > i + n)
                stop = 1;
            if (stop == 0)
                wanted += 1;
        }
    CHECK("break 2", sum, wanted, 0)
    float k = 0, steps = 0;
    while (k * k < n) {
        k += 1;
        steps += 1;
    }
    CHECK("while", steps, ceil(sqrt(n)), 0)
    float which = (n < 4) ? 1 : 2;
    if (n < 4 && t < 2)
        which -= 1;
    else if (n >= 4 || t > 2)
        which -= 2;
    else
        which = 99;
    CHECK("branches", which, 0, 0)
    END_CHECKS
}
