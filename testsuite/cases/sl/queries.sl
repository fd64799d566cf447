// SPDX-License-Identifier: Apache-2.0
// rule: option, attribute, rendererinfo, shadername and the ray queries answer; an unknown name leaves the variable alone.
// spec: RI 3.2, Shading Language, Message passing and information functions
// scene: plate 8 | Attribute "user" "uniform float level" .25
// expect: [line for line in output if "wrong" in line][:3] == []
// expect: mean("out.tif") == vec(1, 1, 1, 1) +- 1e-6 | every check of every point held
#include "check.h"
surface queries()
{
    BEGIN_CHECKS
    float format[3] = {0, 0, 0};
    float sides = -1, missing = -7, found;
    color shade = 0;
    string renderer = "";
    CHECK("option found", option("Format", format), 1, 0)
    CHECK("xres", format[0], 8, 0)
    CHECK("yres", format[1], 8, 0)
    CHECK("unknown option", option("no:such", missing), 0, 0)
    CHECK("left alone", missing, -7, 0)
    CHECK("attribute found", attribute("Sides", sides), 1, 0)
    CHECK("sides", sides, 2, 0)
    CHECK("Ri:Color", attribute("Ri:Color", shade), 1, 0)
    CHECK_COLOR("colour", shade, color(1, 1, 1), 0)
    found = attribute("user:level", missing);
    CHECK("user attribute", missing, .25, 0)
    CHECK("renderer", rendererinfo("renderer", renderer), 1, 0)
    CHECK("has a name", (renderer != "") ? 1 : 0, 1, 0)
    CHECK("shadername", (shadername() == "queries") ? 1 : 0, 1, 0)
    CHECK("shadername of none", (shadername("displacement") == "") ? 1 : 0, 1, 0)
    CHECK("raylevel", raylevel(), 0, 0)
    CHECK("isshadowray", isshadowray(), 0, 0)
    END_CHECKS
}
