// SPDX-License-Identifier: Apache-2.0
// rule: Area operators see what a function of a DSO gives at the neighbouring points.
// spec: docs/shadeops.md
// scene: plate 8
// run: render -shadeops {build}/runtime/base/test {scene}
// quiet: dsobroken
// expect: [line for line in output if "wrong" in line][:3] == []
// expect: mean("out.tif") == vec(1, 1, 1, 1) +- 1e-6 | every check of every point held
#include "check.h"
surface neighbours()
{
    BEGIN_CHECKS
    float squared;
    CHECK("of a result", Du(dsosum(dsoscale(u, 3), v)), 3, 1e-3)
    CHECK("by v", Dv(dsosum(dsoscale(u, 3), v)), 1, 1e-3)
    point turned = dsoturn(point (u, v, 0), squared);
    CHECK3("of a point", Du(turned), vector (0, 1, 0), 1e-3)
    CHECK("of an output", Du(squared), 2 * u + du, 1e-3)
    END_CHECKS
}
