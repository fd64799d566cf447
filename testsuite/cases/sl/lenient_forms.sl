// SPDX-License-Identifier: Apache-2.0
// rule: Components by index, float functions of triples, lists for triples, '%', x++, do, variables named normal and vector, and
//   functions that follow their use compute what their reading says (docs/shading-language.md), for each point.
// spec: extensions
// scene: plate 8
// quiet: lenient_forms\.sl:\d+:\d+: warning: | each form is named when it is compiled, not when it comes from the cache
// expect: [line for line in output if "wrong" in line][:3] == []
// expect: mean("out.tif") == vec(1, 1, 1, 1) +- 1e-6 | every check of every point held
#include "check.h"
surface lenient_forms(float given;)
{
    BEGIN_CHECKS
    float varies = s > .5 ? 2 : 0; /* another component for each half */
    color c = {1, 2, 3};
    CHECK("read", c[varies], s > .5 ? 3 : 1, 0)
    c[varies] = 9;
    c[1] += 1;
    CHECK_COLOR("write", c, s > .5 ? color(1, 3, 9) : color(9, 3, 3), 0)
    point many[2];
    many[1] = (1, 2, 3);
    many[1][varies] *= 2;
    CHECK3("array", vector many[1], s > .5 ? vector(1, 2, 6) : vector(2, 2, 3), 0)
    matrix m = 1;
    m[3][varies] = 4;
    CHECK("matrix", m[3][0] + 10 * m[3][2], s > .5 ? 40 : 4, 0)
    CHECK_COLOR("by component", sqrt(color(4, 9, 16)) + max(color(1, 5, 2), 3) + pow(2, color(1, 2, 3)),
                color(2 + 3 + 2, 3 + 5 + 4, 4 + 3 + 8), 1e-4)
    CHECK("remainder", (varies - 3) % 5, s > .5 ? 4 : 2, 0)
    float i = 0, rounds = 0;
    do {
        i++;
        rounds += 1;
        if (rounds > varies + 4)
            break;
    } while (i < 3 || s > .5);
    CHECK("do", i, s > .5 ? 7 : 3, 0)
    point normal = (1, 2, 3), vector = normal * 2;
    vector -= normal;
    CHECK("old names", normal . vector, 14, 0)
    CHECK("default", given, 0, 0)
    CHECK("later", defined_later(varies), varies + 1, 0)
    END_CHECKS
}
float defined_later(float x) { return x + 1; }
