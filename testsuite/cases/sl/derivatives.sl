// SPDX-License-Identifier: Apache-2.0
// rule: Area operators differentiate their arguments over the surface: Du(u) = 1, Dv(u) = 0, Du(P) = dPdu, area(P) =
//   |dPdu ^ dPdv| du dv, calculatenormal(P) lies along Ng, constants and uniform values have derivative 0, and all of it
//   holds in functions, loops, and below uniform and varying conditions.
// spec: RI 3.2, Shading Language, Derivatives; Geometric functions
// scene: plate 8
// expect: [line for line in output if "wrong" in line][:3] == []
// expect: mean("out.tif") == vec(1, 1, 1, 1) +- 1e-6 | every check of every point held
#include "check.h"
float square(float x)
{
    if (x > .5)
        return x * x;
    return x * x;
}
float width(float x)
{
    extern float du, dv;
    return abs(Du(x)) * du + abs(Dv(x)) * dv;
}
void split(float x; output float a, b;)
{
    a = x * x;
    b = 3 * x;
}
surface derivatives(uniform float k = 2;)
{
    BEGIN_CHECKS
    /* Differences to the next sample, not limits: d(x x) = (2 x + dx) dx. */
    CHECK("Du(u)", Du(u), 1, 1e-6)
    CHECK("Dv(u)", Dv(u), 0, 0)
    CHECK("Du(v)", Du(v), 0, 0)
    CHECK("Dv(v)", Dv(v), 1, 1e-6)
    CHECK("constant", Du(3) + Dv(k), 0, 0)
    CHECK3("Du(P)", Du(P), dPdu, 1e-5)
    CHECK3("Dv(P)", Dv(P), dPdv, 1e-5)
    CHECK("area(P)", area(P) / (length(dPdu ^ dPdv) * du * dv), 1, 1e-5)
    CHECK3("calculatenormal(P)", normalize(calculatenormal(P)), normalize(Ng), 1e-5)
    CHECK("length", length(calculatenormal(P)) / length(dPdu ^ dPdv), 1, 1e-5)
    CHECK3("Deriv(P, u)", Deriv(P, u), dPdu, 1e-5)
    CHECK("Deriv(u, u + v)", Deriv(u * u, u + v), 2 * u + du, 1e-5)
    CHECK("function", Du(square(u)), 2 * u + du, 1e-4)
    CHECK("width", width(2 * u) / (2 * du), 1, 1e-5)
    float a, b;
    split(u, a, b);
    CHECK("output parameters", Du(a) + Du(b), 2 * u + du + 3, 1e-4)
    float x = u;
    if (k > 1)
        x = x * x;
    CHECK("uniform condition", Du(x), 2 * u + du, 1e-4)
    float y = v;
    if (v < 2)
        y = 3 * v;
    CHECK("varying condition", Dv(y), 3, 1e-4)
    float inside = 0;
    if (u > .25)
        inside = Du(u * u) - (2 * u + du);
    CHECK("operator below a varying condition", inside, 0, 1e-4)
    float i, sum = 0;
    for (i = 0; i < 4; i += 1) {
        if (u < 0)
            break;
        sum += u * i;
    }
    CHECK("loop", Du(sum), 6, 1e-4)
    float p[3];
    p[0] = u;
    p[1] = p[0] * p[0];
    CHECK("array", Du(p[1]), 2 * u + du, 1e-4)
    point PP = P + .5 * u * normalize(N);
    CHECK3("bump idiom", calculatenormal(PP) / length(Du(PP) ^ Dv(PP)), calculatenormal(PP) / length(calculatenormal(PP)), 1e-4)
    CHECK3("moved along the normal", Du(PP) - dPdu, .5 * normalize(N), 1e-4)
    CHECK("random", Du(random()) * 0, 0, 0)
    CHECK("lights", comp(Du(diffuse(N)), 0), 0, 0)
    float sdu = Du(s), sdv = Dv(s);
    s = 3 * s;
    CHECK("assigned s", Du(s) + Dv(s), 3 * (sdu + sdv), 1e-4)
    END_CHECKS
}
