// SPDX-License-Identifier: Apache-2.0
// rule: reflect, refract, fresnel, faceforward, rotate, ptlined and normalize follow their formulas.
// spec: RI 3.2, Shading Language, Geometric functions
// scene: plate 8
// expect: [line for line in output if "wrong" in line][:3] == []
// expect: mean("out.tif") == vec(1, 1, 1, 1) +- 1e-6 | every check of every point held
#include "check.h"
surface geometry_rules()
{
    BEGIN_CHECKS
    float zero = s - s;
    vector i = normalize(vector(1 + zero, -1, 0));
    vector up = vector(0, 1, 0);
    CHECK3("reflect", reflect(i, up), normalize(vector(1, 1, 0)), 1e-6)
    CHECK3("reflect keeps length", reflect(vector(3 + zero, -4, 0), up), vector(3, 4, 0), 1e-6)
    vector r = refract(i, up, 1 / 1.5);
    CHECK("Snell", xcomp(r), sqrt(.5) / 1.5, 1e-6)
    CHECK("unit", length(r), 1, 1e-6)
    CHECK3("total internal reflection", refract(i, up, 1.5), vector(0, 0, 0), 0)
    float kr, kt;
    vector fr, ft;
    fresnel(vector(zero, -1, 0), up, 1 / 1.5, kr, kt);
    CHECK("normal incidence", kr, .04, 1e-6)
    CHECK("the rest", kt, .96, 1e-6)
    fresnel(i, up, 1.5, kr, kt, fr, ft);
    CHECK("all reflected", kr, 1, 1e-6)
    CHECK3("R", fr, normalize(vector(1, 1, 0)), 1e-6)
    CHECK3("T", ft, vector(0, 0, 0), 0)
    fresnel(normalize(vector(1, -1e-4 + zero, 0)), up, 1 / 1.5, kr, kt);
    CHECK("grazing", kr, 1, 2e-3)
    CHECK3("faceforward", faceforward(up, vector(zero, 1, 0), up), -up, 0)
    CHECK3("faceforward kept", faceforward(up, vector(zero, -1, 0), up), up, 0)
    CHECK3("rotate", rotate(point(1 + zero, 0, 0), PI / 2, point(0, 0, 0), point(0, 0, 1)), point(0, 1, 0), 1e-6)
    CHECK3("rotate about a line", rotate(point(2 + zero, 0, 0), PI, point(1, 0, 0), point(1, 5, 0)), point(0, 0, 0), 1e-6)
    CHECK("ptlined", ptlined(point(0, 0, 0), point(1, 0, 0), point(.5 + zero, 2, 0)), 2, 1e-6)
    CHECK("ptlined past the end", ptlined(point(0, 0, 0), point(1, 0, 0), point(4 + zero, 4, 0)), 5, 1e-6)
    CHECK3("normalize of zero", normalize(vector(zero, 0, 0)), vector(0, 0, 0), 0)
    CHECK("length", length(vector(3 + zero, 4, 12)), 13, 1e-5)
    CHECK("distance", distance(point(1 + zero, 1, 1), point(1, 4, 5)), 5, 1e-6)
    CHECK3("cross", vector(1 + zero, 0, 0) ^ up, vector(0, 0, 1), 0)
    CHECK("dot", vector(1 + zero, 2, 3) . vector(4, 5, 6), 32, 0)
    point p = point(1 + zero, 2, 3);
    setxcomp(p, 7);
    setycomp(p, 8);
    setzcomp(p, 9);
    CHECK3("setcomp", p, point(7, 8, 9), 0)
    END_CHECKS
}
