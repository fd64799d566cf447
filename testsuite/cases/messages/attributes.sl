// SPDX-License-Identifier: Apache-2.0
// rule: attribute() finds the standard attributes with and without "Ri:", user attributes of any type, implementation
//   attributes with their defaults, and what geometry says about the point; option() the options.
// spec: RI 3.2, Shading Language, Message passing and information functions
// scene: plate 8 | Attribute "user" "color tint" [.5 .25 .125] "string label" "oak" "float[3] three" [1 2 3] "int count" [4] "point place" [1 2 3] Attribute "identifier" "name" "plate" ShadingRate 2 Sides 1 Orientation "outside" ShadingInterpolation "smooth" TextureCoordinates 0 0 2 0 0 2 2 2 DetailRange 0 0 1e38 1e38
// expect: [line for line in output if "wrong" in line][:3] == []
// expect: mean("out.tif") == vec(1, 1, 1, 1) +- 1e-6 | every check of every point held
#include "check.h"
#define FOUND(call) CHECK("found", call, 1, 0)
surface attributes()
{
    BEGIN_CHECKS
    float one = -1, three[3] = {0, 0, 0}, four[4] = {0, 0, 0, 0}, eight[8] = {0, 0, 0, 0, 0, 0, 0, 0};
    float two[2] = {0, 0};
    color tint = 0;
    point place = 0;
    string text = "";
    matrix object = 1;
    normal facing = 0;
    FOUND(attribute("ShadingRate", one))
    CHECK("ShadingRate", one, 2, 0)
    FOUND(attribute("Ri:ShadingRate", one))
    CHECK("Ri:ShadingRate", one, 2, 0)
    FOUND(attribute("Ri:Sides", one))
    CHECK("Ri:Sides", one, 1, 0)
    FOUND(attribute("matte", one))
    CHECK("matte", one, 0, 0)
    FOUND(attribute("Ri:Color", tint))
    CHECK_COLOR("Ri:Color", tint, color(1, 1, 1), 0)
    FOUND(attribute("Ri:Orientation", text))
    CHECK("Ri:Orientation", (text == "outside") ? 1 : 0, 1, 0)
    FOUND(attribute("Ri:ShadingInterpolation", text))
    CHECK("Ri:ShadingInterpolation", (text == "smooth") ? 1 : 0, 1, 0)
    FOUND(attribute("Ri:TextureCoordinates", eight))
    CHECK("Ri:TextureCoordinates", eight[2], 2, 0)
    FOUND(attribute("Ri:DetailRange", four))
    CHECK("Ri:DetailRange", four[3] / 1e38, 1, 1e-6)
    FOUND(attribute("Ri:Transformation", object))
    CHECK("Ri:Transformation", comp(object, 0, 0), 1, 1e-6)
    FOUND(attribute("user:tint", tint))
    CHECK_COLOR("user:tint", tint, color(.5, .25, .125), 0)
    FOUND(attribute("user:label", text))
    CHECK("user:label", (text == "oak") ? 1 : 0, 1, 0)
    FOUND(attribute("user:three", three))
    CHECK("user:three", three[2], 3, 0)
    FOUND(attribute("user:count", one))
    CHECK("user:count", one, 4, 0)
    FOUND(attribute("identifier:name", text))
    CHECK("identifier:name", (text == "plate") ? 1 : 0, 1, 0)
    FOUND(attribute("displacementbound:sphere", one))
    CHECK("its default", one, 0, 0)
    FOUND(attribute("geometry:backfacing", one))
    CHECK("geometry:backfacing", one, 0, 0)
    FOUND(attribute("geometry:geometricnormal", facing))
    CHECK3("geometry:geometricnormal", facing, Ng, 1e-6)
    CHECK("no such attribute", attribute("user:nothing", one), 0, 0)
    CHECK("another type", attribute("user:label", one), 0, 0)
    CHECK("another length", attribute("user:three", two), 0, 0)
    FOUND(option("Format", three))
    FOUND(option("DeviceResolution", three))
    CHECK("DeviceResolution", three[0], 8, 0)
    FOUND(option("DeviceFrame", one))
    FOUND(option("FrameAspectRatio", one))
    CHECK("FrameAspectRatio", one, 1, 1e-6)
    FOUND(option("CropWindow", four))
    CHECK("CropWindow", four[1], 1, 0)
    FOUND(option("DepthOfField", three))
    FOUND(option("Shutter", two))
    FOUND(option("Clipping", two))
    CHECK("Clipping", two[1], 4.5, 0)
    FOUND(option("Ri:Exposure", two))
    CHECK("Exposure", two[0], 1, 0)
    FOUND(option("limits:gridsize", one))
    CHECK("its default", one, 256, 0)
    float version[4] = {-1, -1, -1, -1};
    FOUND(rendererinfo("version", version))
    FOUND(rendererinfo("versionstring", text))
    CHECK("no such thing", rendererinfo("colour", text), 0, 0)
    END_CHECKS
}
