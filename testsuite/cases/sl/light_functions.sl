// SPDX-License-Identifier: Apache-2.0
// rule: ambient, diffuse, specular, phong and specularbrdf sum the lights by their formulas.
// spec: RI 3.2, Shading Language, Shading and lighting functions
// scene: plate 8 | LightSource "distantlight" 1 "to" [0 0 1] LightSource "distantlight" 2 "to" [-.6 0 .8] "intensity" .5 "lightcolor" [1 .5 .25] LightSource "ambientlight" 3 "intensity" .125
// expect: [line for line in output if "wrong" in line][:3] == []
// expect: mean("out.tif") == vec(1, 1, 1, 1) +- 1e-6 | every check of every point held
#include "check.h"
surface light_functions()
{
    BEGIN_CHECKS
    normal n = normalize(ntransform("camera", "current", normal(0, .6, -.8)));
    vector v = normalize(vtransform("camera", "current", vector(.48, .36, -.8)));
    // Towards the lights: (0, 0, -1) with 1, (0.6, 0, -0.8) with (1, .5, .25) / 2; the ambient light gives 1/8.
    CHECK_COLOR("ambient", ambient(), color(.125, .125, .125), 1e-6)
    CHECK_COLOR("diffuse", diffuse(n), .8 * color(1, 1, 1) + .64 * color(.5, .25, .125), 4e-6)
    // Halves: H1 = normalize(.48, .36, -1.8), H2 = normalize(1.08, .36, -1.6).
    float h1 = (.6 * .36 + .8 * 1.8) / sqrt(.48 * .48 + .36 * .36 + 1.8 * 1.8);
    float h2 = (.6 * .36 + .8 * 1.6) / sqrt(1.08 * 1.08 + .36 * .36 + 1.6 * 1.6);
    CHECK_COLOR("specular", specular(n, v, .2), pow(h1, 5) * color(1, 1, 1) + pow(h2, 5) * color(.5, .25, .125), 1e-5)
    vector l1 = vtransform("camera", "current", vector(0, 0, -1));
    CHECK_COLOR("specularbrdf", specularbrdf(l1, n, v, .2), color(1, 1, 1) * pow(h1, 5), 1e-5)
    // Mirror direction: 2 (N.V) N - V with N.V = .856.
    float r1 = 2 * .856 * .8 - .8;
    float r2 = .6 * -.48 + .8 * r1;
    CHECK_COLOR("phong", phong(n, v, 6), pow(r1, 6) * color(1, 1, 1) + pow(max(0, r2), 6) * color(.5, .25, .125), 1e-5)
    END_CHECKS
}
