// SPDX-License-Identifier: Apache-2.0
// rule: diffuse(), specular() and ambient() inside an illuminance loop leave L, Cl and the order of the loop alone.
// spec: not in the specification, which forbids nesting; as point-at-a-time renderers have it
// scene: plate 8 | LightSource "distantlight" 1 "to" [0 0 1] LightSource "distantlight" 2 "to" [-.6 0 .8] "intensity" .5 LightSource "ambientlight" 3 "intensity" .125
// expect: [line for line in output if "wrong" in line][:3] == []
// expect: mean("out.tif") == vec(1, 1, 1, 1) +- 1e-6 | every check of every point held
#include "check.h"
surface lighting_inside_illuminance()
{
    BEGIN_CHECKS
    normal n = ntransform("world", "current", normal(0, 0, -1));
    color sum = 0;
    float num = 0;
    illuminance (P, n, PI / 2) {
        vector before = L;
        color colour = Cl;
        color inner = diffuse(n) + ambient() + specular(n, n, 1);
        CHECK3("L", L, before, 0)
        CHECK_COLOR("Cl", Cl, colour, 0)
        CHECK("inner", comp(inner, 0), 1 + .4 + .125 + 1 + .5 * .9486833, 1e-4)
        sum += Cl;
        num += 1;
    }
    CHECK("lights", num, 2, 0)
    CHECK_COLOR("sum", sum, color(1.5, 1.5, 1.5), 1e-6)
    END_CHECKS
}
