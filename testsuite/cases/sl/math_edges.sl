// SPDX-License-Identifier: Apache-2.0
// rule: The corners of the mathematical functions: mod, pow, sqrt, log, atan, sign and rounding.
// spec: RI 3.2, Shading Language, Mathematical functions
// scene: plate 8
// expect: [line for line in output if "wrong" in line][:3] == []
// expect: mean("out.tif") == vec(1, 1, 1, 1) +- 1e-6 | every check of every point held
#include "check.h"
surface math_edges()
{
    BEGIN_CHECKS
    // zero is varying, so that nothing is folded away.
    float zero = s - s;
    CHECK("mod(-.2,1)", mod(zero - .2, 1), 0.8, 1e-6)
    CHECK("mod(5,3)", mod(zero + 5, 3), 2, 0)
    CHECK("mod(5,-3)", mod(zero + 5, -3), -1, 0)
    CHECK("mod(1,0)", mod(zero + 1, zero), 0, 0)
    CHECK("sign(0)", sign(zero), 0, 0)
    CHECK("sign(-3)", sign(zero - 3), -1, 0)
    CHECK("sign(2)", sign(zero + 2), 1, 0)
    CHECK("pow(-1,.5)", pow(zero - 1, .5), 0, 0)
    CHECK("pow(-2,3)", pow(zero - 2, 3), -8, 1e-5)
    CHECK("pow(0,0)", pow(zero, zero), 1, 0)
    CHECK("pow(2,10)", pow(zero + 2, 10), 1024, 1e-3)
    CHECK("sqrt(-1)", sqrt(zero - 1), 0, 0)
    CHECK("sqrt(2)", sqrt(zero + 2), 1.41421356, 2e-7)
    CHECK("inversesqrt(0)", inversesqrt(zero), 0, 0)
    CHECK("inversesqrt(4)", inversesqrt(zero + 4), 0.5, 1e-6)
    CHECK("log(8,2)", log(zero + 8, 2), 3, 1e-6)
    CHECK("log(exp(3))", log(exp(zero + 3)), 3, 1e-6)
    CHECK("exp(-2)", exp(zero - 2), 0.13533528, 1e-7)
    CHECK("atan(1)", atan(zero + 1), PI / 4, 2e-7)
    CHECK("atan(0,-1)", atan(zero, zero - 1), PI, 4e-7)
    CHECK("atan(-1,-1)", atan(zero - 1, zero - 1), -3 * PI / 4, 4e-7)
    CHECK("atan(0,0)", atan(zero, zero), 0, 0)
    CHECK("asin(2)", asin(zero + 2), PI / 2, 3e-7)
    CHECK("acos(-2)", acos(zero - 2), PI, 4e-7)
    CHECK("acos(.5)", acos(zero + .5), PI / 3, 3e-7)
    CHECK("floor(-.5)", floor(zero - .5), -1, 0)
    CHECK("ceil(-.5)", ceil(zero - .5), 0, 0)
    CHECK("round(2.5)", round(zero + 2.5), 3, 0)
    CHECK("round(-2.5)", round(zero - 2.5), -2, 0)
    CHECK("round(1.4)", round(zero + 1.4), 1, 0)
    CHECK("abs(-3)", abs(zero - 3), 3, 0)
    CHECK("radians(180)", radians(zero + 180), PI, 4e-7)
    CHECK("degrees(PI)", degrees(zero + PI), 180, 3e-5)
    CHECK("sin(1)", sin(zero + 1), 0.84147098, 2e-7)
    CHECK("cos(100)", cos(zero + 100), 0.86231887, 1e-6)
    CHECK("tan(-1)", tan(zero - 1), -1.55740772, 5e-7)
    CHECK("erf(.5)", erf(zero + .5), 0.52049988, 1e-6)
    CHECK("erfc(2)", erfc(zero + 2), 0.00467773, 1e-6)
    END_CHECKS
}
