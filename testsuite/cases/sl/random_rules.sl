// SPDX-License-Identifier: Apache-2.0
// rule: random is in 0..1, new at each execution and each point; the same in every run.
// spec: RI 3.2, Shading Language, random
// scene: plate 8
// expect: [line for line in output if "wrong" in line][:3] == []
// expect: mean("out.tif") == vec(1, 1, 1, 1) +- 1e-6 | every check of every point held
#include "check.h"
surface random_rules()
{
    BEGIN_CHECKS
    float i, sum = 0, low = 1, high = 0;
    for (i = 0; i < 400; i += 1) {
        float r = random();
        sum += r;
        low = min(low, r);
        high = max(high, r);
    }
    // 400 values: standard error of the mean 0.0144; the chance of all below .95 is 1e-9.
    CHECK("mean", sum / 400, .5, .08)
    CHECK("range below", step(0, low), 1, 0)
    CHECK("range above", step(1, high), 0, 0)
    CHECK("spread", step(.9, high - low), 1, 0)
    float a = random(), b = random();
    CHECK("new value", step(1e-7, abs(a - b)), 1, 0)
    END_CHECKS
}
