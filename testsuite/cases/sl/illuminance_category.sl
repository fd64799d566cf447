// SPDX-License-Identifier: Apache-2.0
// rule: A category selects lights by __category; -name those without it; lights without any match no positive name.
//   Several are joined by & (both) and | (either), & first.
// spec: RI 3.2, Shading Language, Illuminance statement
// scene: plate 8 | LightSource "labelledlight" 1 "string __category" "key,rim" LightSource "labelledlight" 2 "string __category" "key" LightSource "distantlight" 3 "to" [0 0 1]
// expect: [line for line in output if "wrong" in line][:3] == []
// expect: mean("out.tif") == vec(1, 1, 1, 1) +- 1e-6 | every check of every point held
#include "check.h"
surface illuminance_category()
{
    BEGIN_CHECKS
    float key = 0, notkey = 0, any = 0, nothing = 0, both = 0, either = 0, mixed = 0;
    illuminance ("key", P)
        key += 1;
    illuminance ("-key", P)
        notkey += 1;
    illuminance ("", P)
        any += 1;
    illuminance ("nobody", P)
        nothing += 1;
    illuminance ("key&rim", P)
        both += 1;
    illuminance ("rim | nobody", P)
        either += 1;
    illuminance ("key & -rim | nobody", P)
        mixed += 1;
    CHECK("&", both, 1, 0)
    CHECK("|", either, 1, 0)
    CHECK("& -", mixed, 1, 0)
    CHECK("key", key, 2, 0)
    CHECK("-key", notkey, 1, 0)
    CHECK("all", any, 3, 0)
    CHECK("none", nothing, 0, 0)
    END_CHECKS
}
