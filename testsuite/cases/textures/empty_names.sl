// SPDX-License-Identifier: Apache-2.0
// rule: Maps without a name are no error: texture is white as a color, 0 as a float; nothing is reflected, in shadow or bent.
// spec: RI 3.2, Shading Language, texture, environment, shadow; docs/textures.md
// scene: plate 8
// expect: [line for line in output if "wrong" in line][:3] == []
// expect: mean("out.tif") == vec(1, 1, 1, 1) +- 1e-6 | every check of every point held
#include "check.h"
surface empty_names(string none = "";)
{
    BEGIN_CHECKS
    uniform float found = 7;
    CHECK_COLOR("color texture", texture(none), color(1, 1, 1), 0)
    CHECK_COLOR("with coordinates", texture(none, s, t, "blur", .1), color(1, 1, 1), 0)
    CHECK("float texture", float texture(none[2], s, t), 0, 0)
    CHECK("four corners", float texture(none, s, t, s, t, s, t, s, t), 0, 0)
    CHECK_COLOR("environment", environment(none, I), color(0, 0, 0), 0)
    CHECK("shadow", float shadow(none, P, "samples", 4), 0, 0)
    CHECK("bump", distance(point bump(none, N, dPdu, dPdv, s, t), point N), 0, 0)
    CHECK("textureinfo", textureinfo(none, "exists", found), 0, 0)
    CHECK("untouched", found, 7, 0)
    END_CHECKS
}
