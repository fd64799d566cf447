// SPDX-License-Identifier: Apache-2.0
// rule: illuminance visits lights within its cone, in order; L points to the light; angle PI sees those behind.
// spec: RI 3.2, Shading Language, Illuminance statement
// scene: plate 8 | LightSource "distantlight" 1 "to" [0 0 1] LightSource "distantlight" 2 "to" [0 0 1] "intensity" .5 LightSource "distantlight" 3 "to" [0 0 -1] LightSource "ambientlight" 4
// expect: [line for line in output if "wrong" in line][:3] == []
// expect: mean("out.tif") == vec(1, 1, 1, 1) +- 1e-6 | every check of every point held
#include "check.h"
surface illuminance_forms()
{
    BEGIN_CHECKS
    float n = 0, behind = 0, all = 0;
    color sum = 0;
    vector front = normalize(vector ntransform("camera", "current", normal(0, 0, -1)));
    illuminance (P, front, PI / 2) {
        n += 1;
        sum += Cl;
        CHECK("L to the light", step(0, L . front), 1, 0)
    }
    illuminance (P, front, PI)
        all += 1;
    illuminance (P)
        behind += 1;
    CHECK("in front", n, 2, 0)
    CHECK("angle PI", all, 3, 0)
    CHECK("whole sphere", behind, 3, 0)
    CHECK_COLOR("Cl", sum, color(1.5, 1.5, 1.5), 1e-5)
    float first = 0;
    illuminance (P, front, PI) {
        first = comp(Cl, 0);
        break;
    }
    CHECK("break after the first", first, 1, 1e-6)
    END_CHECKS
}
