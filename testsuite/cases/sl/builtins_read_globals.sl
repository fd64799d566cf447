// SPDX-License-Identifier: Apache-2.0
// rule: Built-in functions read the predefined variables, never variables of the same name; what a shader assigns to P
//   they see from then on.
// spec: RI 3.2, Shading Language, Shading and lighting functions; predefined variables
// scene: plate 8 | LightSource "pointlight" 1 "from" [0 0 0] "intensity" 4
// expect: [line for line in output if "wrong" in line][:3] == []
// expect: mean("out.tif") == vec(1, 1, 1, 1) +- 1e-6 | every check of every point held
#include "check.h"
color lit(normal n; point P) { return diffuse(n); }
normal turned(normal n; normal Ng) { extern vector I; return faceforward(n, I); }
surface builtins_read_globals()
{
    BEGIN_CHECKS
    normal n = ntransform("world", "current", normal(0, 0, -1));
    point light = point "world" (0, 0, 0);
    vector to = light - P;
    float wanted = 4 * (normalize(to) . n) / (to . to);
    CHECK_COLOR("diffuse", diffuse(n), wanted * color(1, 1, 1), 1e-5 * wanted)
    CHECK_COLOR("diffuse beside a formal P", lit(n, point(7, 7, 7)), wanted * color(1, 1, 1), 1e-5 * wanted)
    {
        point P = light;
        CHECK_COLOR("diffuse beside a local P", diffuse(n), wanted * color(1, 1, 1), 1e-5 * wanted)
        CHECK3("local", vector(P - light), vector(0, 0, 0), 0)
    }
    CHECK3("faceforward beside a formal Ng", vector turned(n, -n), vector n, 1e-6)
    P = light + 2 * vtransform("world", "current", vector(0, 0, 1));
    CHECK_COLOR("diffuse after P is assigned", diffuse(n), color(1, 1, 1), 1e-5)
    END_CHECKS
}
