// SPDX-License-Identifier: Apache-2.0
// rule: Points, vectors and normals come back from every space; the conversions follow the matrices.
// spec: RI 3.2, Shading Language, transform
// scene: plate 8
// expect: [line for line in output if "wrong" in line][:3] == []
// expect: mean("out.tif") == vec(1, 1, 1, 1) +- 1e-6 | every check of every point held
#include "check.h"
surface transforms()
{
    BEGIN_CHECKS
    CHECK3("world", transform("world", "current", transform("world", P)), P, 1e-5)
    CHECK3("object", transform("object", "current", transform("object", P)), P, 1e-5)
    CHECK3("camera", transform("camera", "current", transform("camera", P)), P, 1e-5)
    CHECK3("raster", transform("raster", "current", transform("raster", P)), P, 1e-4)
    CHECK3("NDC", transform("NDC", "current", transform("NDC", P)), P, 1e-4)
    CHECK3("world to camera", transform("world", "camera", point(1, 2, 3)), point(1, 2, 5), 1e-6)
    CHECK3("vectors do not move", vtransform("world", "camera", vector(1, 2, 3)), vector(1, 2, 3), 1e-6)
    CHECK3("normals", ntransform("world", "camera", normal(0, 0, 1)), normal(0, 0, 1), 1e-6)
    CHECK3("cast", point "world" (0, 0, 0), transform("world", "current", point(0, 0, 0)), 1e-6)
    matrix m = translate(matrix 1, vector(1, 2, 3));
    CHECK3("matrix", transform(m, point(1, 1, 1)), point(2, 3, 4), 1e-6)
    CHECK("determinant", determinant(scale(matrix 1, vector(2, 3, 4))), 24, 1e-5)
    CHECK("comp", comp(m, 3, 1), 2, 0)
    setcomp(m, 3, 1, 7);
    CHECK("setcomp", comp(m, 3, 1), 7, 0)
    matrix turn = rotate(matrix 1, PI / 2, vector(0, 0, 1));
    CHECK3("rotate", transform(turn, point(1, 0, 0)), point(0, 1, 0), 1e-6)
    CHECK3("inverse", transform(1 / m, transform(m, P)), P, 1e-5)
    END_CHECKS
}
