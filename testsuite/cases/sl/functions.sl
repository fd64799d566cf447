// SPDX-License-Identifier: Apache-2.0
// rule: Functions: output arguments, nested functions with extern, overloads by return type, early formals hiding globals.
// spec: RI 3.2, Shading Language, User-defined functions
// scene: plate 8
// expect: [line for line in output if "wrong" in line][:3] == []
// expect: mean("out.tif") == vec(1, 1, 1, 1) +- 1e-6 | every check of every point held
#include "check.h"
float square(float x)
{
    return x * x;
}

void swap(output float x; output float y;)
{
    float z = x;
    x = y;
    y = z;
}

point hides(point P)
{
    return P;
}

surface functions()
{
    BEGIN_CHECKS
    float depth_of(float x)
    {
        extern float s;
        return x + s;
    }
    CHECK("extern", depth_of(1), 1 + s, 0)
    float a = 1, b = 2;
    swap(a, b);
    CHECK("outputs", a * 10 + b, 21, 0)
    CHECK3("formal hides global", hides(point(1, 2, 3)), point(1, 2, 3), 0)
    CHECK("nested calls", square(square(2 + (s - s))), 16, 0)
    color c;
    c = a = 4;
    CHECK_COLOR("chained assignment", c, color(4, 4, 4), 0)
    vector v = 2 * vector noise(P) - 1;
    CHECK("cast picks the overload", step(1e-6, abs(xcomp(v) - ycomp(v))), 1, 0)
    END_CHECKS
}
