// SPDX-License-Identifier: Apache-2.0
// rule: lightsource() and "light:" are about the light of the illuminance loop around them, also after lighting calls inside
//   it; "send:light:" gives a parameter another value for one execution of the light; "lightcache" may be said.
// spec: RI 3.2, Shading Language, Illuminance statement; PRMan's options of illuminance
// scene: plate 8 | LightSource "distantlight" 1 "to" [0 0 1] "intensity" 1 LightSource "pointlight" 2 "from" [0 0 0] "intensity" 2
// expect: [line for line in output if "wrong" in line][:3] == []
// expect: mean("out.tif") == vec(1, 1, 1, 1) +- 1e-6 | every check of every point held
#include "check.h"
surface light_of_the_loop()
{
    BEGIN_CHECKS
    float before, after, option, round = 0, both = 0;
    string name = "";
    color there = 0, sent = 0;
    illuminance (P, "light:intensity", option) {
        round += 1;
        lightsource("intensity", before);
        there = diffuse(P + vector (0, 0, 1), N, PI / 2); // runs both lights at other points
        lightsource("intensity", after);
        CHECK("first the distant, then the point light", before, round, 0)
        CHECK("the same after the inner loop", after, before, 0)
        CHECK("as option", option, before, 0)
        name = shadername("lightsource");
        CHECK("its name", (name == ((round == 1) ? "distantlight" : "pointlight")) ? 1 : 0, 1, 0)
        both += before;
    }
    CHECK("two lights", both, 3, 0)
    CHECK("outside a loop there is no light", lightsource("intensity", before), 0, 0)
    illuminance (P, "send:light:intensity", 5, "lightcache", "refresh")
        sent += Cl * ((L . L > 1e-12) ? 1 : 0);
    color plain = 0;
    illuminance (P, "lightcache", "reuse")
        plain += Cl;
    // intensity 5 instead of 1 for the distant, 5 instead of 2 for the point light at distance |P|
    float fall = 1 / ((P - point "world" (0, 0, 0)) . (P - point "world" (0, 0, 0)));
    CHECK("sent", comp(sent, 0), 5 + 5 * fall, 1e-4 * (5 + 5 * fall))
    CHECK("and not kept", comp(plain, 0), 1 + 2 * fall, 1e-4 * (1 + 2 * fall))
    END_CHECKS
}
