// SPDX-License-Identifier: Apache-2.0
// rule: Surface, displacement, light and volume shaders see each other's parameters: those of shaders that have run as they
//   left them, of others as they were given; a light sees the surface as it is when it asks for light.
// spec: RI 3.2, Shading Language, Message passing and information functions
// scene: plate 8 | LightSource "asking_light" 1 Displacement "tilt" "slope" .5 Atmosphere "asking_fog" "density" .75 "slope" .5 Interior "fog" "distance" 3 Exterior "fog" "distance" 4
// expect: [line for line in output if "wrong" in line][:3] == []
// expect: mean("out.tif") == vec(1, 1, 1, 1) +- 1e-6 | every check of every point held
// quiet: (Interior|Exterior) "fog"
#include "check.h"
surface between_shaders(float scale = .25; output varying float tone = 7;)
{
    BEGIN_CHECKS
    float height = -1, density = -1, outside = -1, inside = -1, none = -3;
    color first = 0, second = 0;
    tone = 10 * u;
    illuminance (P)
        first += Cl;
    CHECK("tone when the light ran", comp(first, 0), 10 * u, 1e-5)
    CHECK("height of the displacement", comp(first, 1), .5 * u, 1e-6)
    CHECK("parameter of the surface", comp(first, 2), .25, 0)
    tone = 20 * v;
    illuminance (P, N, PI / 2)
        second += Cl;
    CHECK("tone when it ran again", comp(second, 0), 20 * v, 1e-5)
    CHECK("displacement", displacement("height", height), 1, 0)
    CHECK("height", height, .5 * u, 1e-6)
    CHECK("displacement's own", displacement("slope", height), 1, 0)
    CHECK("slope", height, .5, 0)
    CHECK("atmosphere", atmosphere("density", density), 1, 0)
    CHECK("density", density, .75, 0)
    CHECK("incident", incident("distance", outside), 1, 0)
    CHECK("exterior, since the ray comes from outside", outside, 4, 0)
    CHECK("opposite", opposite("distance", inside), 1, 0)
    CHECK("interior", inside, 3, 0)
    CHECK("unknown", displacement("nothing", none), 0, 0)
    CHECK("wrong type", atmosphere("background", none), 0, 0)
    CHECK("left alone", none, -3, 0)
    CHECK("shadername", (shadername("displacement") == "tilt") ? 1 : 0, 1, 0)
    CHECK("shadername", (shadername("atmosphere") == "asking_fog") ? 1 : 0, 1, 0)
    CHECK("shadername", (shadername("interior") == "fog") ? 1 : 0, 1, 0)
    tone = 99;
    END_CHECKS
}
