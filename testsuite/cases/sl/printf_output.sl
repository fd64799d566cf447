// SPDX-License-Identifier: Apache-2.0
// rule: printf prints once per point, once for all points (here one batch of 64) where every argument is uniform, however often
//   the statement is executed, with C's width and precision.
// spec: RI 3.2, Shading Language, printf
// scene: plate 8
// expect: [line for line in output if line.startswith("uniform") and line != "uniform 0.50 3 text"] == []
// expect: len([line for line in output if line.startswith("uniform")]) == 1
// expect: len([line for line in output if line.startswith("loop")]) == 3
// expect: len([line for line in output if line.startswith("masked")]) == 1
// expect: len([line for line in output if line.startswith("point")]) == 64
// expect: [line for line in output if line.startswith("triple")][0] == "triple 1.0 2.0 3.0"
surface printf_output()
{
    printf("uniform %.2f %d %s\n", .5, 3, "text");
    printf("triple %.1p\n", point(1, 2, 3));
    uniform float i;
    for (i = 0; i < 3; i += 1) printf("loop\n");
    if (s < .3) printf("masked\n");
    printf("point %f %f\n", s, t);
    Oi = 1;
    Ci = 1;
}
