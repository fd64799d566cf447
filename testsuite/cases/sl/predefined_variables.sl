// SPDX-License-Identifier: Apache-2.0
// rule: P, N, u, v, s, t, Cs, Os, E, I, ncomps at a plate: as the geometry says.
// spec: RI 3.2, Shading Language, Predefined surface shader variables
// scene: plate 8
// expect: [line for line in output if "wrong" in line][:3] == []
// expect: mean("out.tif") == vec(1, 1, 1, 1) +- 1e-6 | every check of every point held
#include "check.h"
surface predefined_variables()
{
    BEGIN_CHECKS
    CHECK3("E", E, transform("camera", "current", point(0, 0, 0)), 1e-6)
    CHECK3("P", transform("camera", P), point(2 * u - 1, 1 - 2 * v, 2), 1e-5)
    CHECK("s", s, u, 1e-6)
    CHECK("t", t, v, 1e-6)
    CHECK3("dPdu", dPdu, vector(2, 0, 0), 1e-5)
    CHECK3("dPdv", dPdv, vector(0, -2, 0), 1e-5)
    CHECK3("N", normalize(N), normalize(Ng), 1e-6)
    CHECK3("Ng", normalize(Ng), normalize(dPdu ^ dPdv), 1e-6)
    CHECK3("I", vtransform("camera", I), vector(0, 0, 2), 1e-5)
    CHECK_COLOR("Cs", Cs, color(1, 1, 1), 0)
    CHECK("ncomps", ncomps, 3, 0)
    CHECK("du", step(1e-6, du), 1, 0)
    END_CHECKS
}
