// SPDX-License-Identifier: Apache-2.0
// rule: A string that differs from point to point may be given wherever a built-in function takes a string.
// spec: RI 3.2, Shading Language, Strings
// scene: plate 8
// expect: [line for line in output if "wrong" in line][:3] == []
// expect: mean("out.tif") == vec(1, 1, 1, 1) +- 1e-6 | every check of every point held
#include "check.h"
surface varying_strings()
{
    BEGIN_CHECKS
    string space = (u < .3) ? "world" : (u < .6) ? "camera" : "raster";
    point wanted = (u < .3) ? transform("world", P) : (u < .6) ? P : transform("raster", P);
    CHECK3("transform", transform(space, P), wanted, 1e-5)
    string model = (v < .5) ? "hsv" : "YIQ";
    color rgb = color(.25, .5, .75);
    CHECK_COLOR("ctransform", ctransform(model, rgb),
                (v < .5) ? ctransform("hsv", rgb) : ctransform("YIQ", rgb), 1e-6)
    string basis = (u < .5) ? "linear" : "bezier";
    CHECK("spline", spline(basis, v, 0, 1, 3, 2),
          (u < .5) ? spline("linear", v, 0, 1, 3, 2) : spline("bezier", v, 0, 1, 3, 2), 1e-6)
    string both = concat(space, "-", model);
    CHECK("concat", (both == concat((u < .3) ? "world" : (u < .6) ? "camera" : "raster",
                                    (v < .5) ? "-hsv" : "-YIQ")) ? 1 : 0, 1, 0)
    CHECK("match", match("^w", space), (u < .3) ? 1 : 0, 0)
    CHECK("match both", match(concat(model, "$"), both), 1, 0)
    CHECK("format", (format(concat("%s/", model), space) == concat(space, "/", model)) ? 1 : 0, 1, 0)
    if (u < .5) {
        float sides = -1;
        string name = (v < .5) ? "Sides" : "no:such";
        CHECK("attribute", attribute(name, sides), (v < .5) ? 1 : 0, 0)
        CHECK("only there", sides, (v < .5) ? 2 : -1, 0)
    }
    END_CHECKS
}
