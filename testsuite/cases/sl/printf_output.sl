// SPDX-License-Identifier: Apache-2.0
// rule: printf prints once per point, once for uniform arguments, with C's width and precision.
// spec: RI 3.2, Shading Language, printf
// scene: plate 8
// expect: [line for line in output if line.startswith("uniform") and line != "uniform 0.50 3 text"] == []
// expect: len([line for line in output if line.startswith("uniform")]) >= 1
// expect: [line for line in output if line.startswith("triple")][0] == "triple 1.0 2.0 3.0"
surface printf_output()
{
    printf("uniform %.2f %d %s\n", .5, 3, "text");
    printf("triple %.1p\n", point(1, 2, 3));
    Oi = 1;
    Ci = 1;
}
