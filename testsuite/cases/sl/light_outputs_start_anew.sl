// SPDX-License-Identifier: Apache-2.0
// rule: Cl and output parameters of a light start anew at each execution; the L it assigns reaches the surface negated;
//   a weight __nonspecular of 1 keeps it out of specular(), not out of diffuse().
// spec: RI 3.2, Shading Language, Illuminance and Illuminate; __nonspecular as all renderers have it
// scene: plate 8 | LightSource "bentlight" 1
// expect: [line for line in output if "wrong" in line][:3] == []
// expect: mean("out.tif") == vec(1, 1, 1, 1) +- 1e-6 | every check of every point held
#include "check.h"
surface light_outputs_start_anew()
{
    BEGIN_CHECKS
    uniform float i;
    float runs, num = 0;
    for (i = 0; i < 3; i += 1) {
        illuminance (P) {
            num += 1;
            lightsource("runs", runs);
            CHECK("runs", runs, 1, 0)
            CHECK_COLOR("Cl", Cl, color(.5, .5, .5), 1e-6)
            CHECK3("L", L, vtransform("world", "current", vector(-1.2, 0, -1.6)), 1e-5)
        }
    }
    CHECK("rounds", num, 3, 0)
    normal n = ntransform("world", "current", normal(0, 0, -1));
    CHECK_COLOR("diffuse", diffuse(n), color(.4, .4, .4), 1e-5)
    CHECK_COLOR("specular", specular(n, n, .1), color(0, 0, 0), 1e-6)
    END_CHECKS
}
