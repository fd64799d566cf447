// SPDX-License-Identifier: Apache-2.0
// rule: lightsource() reads a light's parameter inside illuminance and leaves the variable alone where there is none.
// spec: RI 3.2, Shading Language, Message passing
// scene: plate 8 | LightSource "distantlight" 1 "to" [0 0 1] "intensity" .75
// expect: [line for line in output if "wrong" in line][:3] == []
// expect: mean("out.tif") == vec(1, 1, 1, 1) +- 1e-6 | every check of every point held
#include "check.h"
surface light_messages()
{
    BEGIN_CHECKS
    float strength = -1, none = -5, found = 0, missed = 1;
    illuminance (P) {
        found = lightsource("intensity", strength);
        missed = lightsource("no_such_parameter", none);
    }
    CHECK("found", found, 1, 0)
    CHECK("value", strength, .75, 1e-6)
    CHECK("missed", missed, 0, 0)
    CHECK("left alone", none, -5, 0)
    END_CHECKS
}
