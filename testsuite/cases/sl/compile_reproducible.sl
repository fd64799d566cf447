// SPDX-License-Identifier: Apache-2.0
// rule: The same source gives the same object, byte by byte.
// spec: design (shaders)
// run one: slc -o out.slo {case}
// run two: slc -o out.slo {case}
// expect: file_bytes("one/out.slo") == file_bytes("two/out.slo")
surface compile_reproducible(float Kd = .5; string name = "x"; point at = point "world" (1, 2, 3);)
{
    Ci = Kd * noise(P) * Cs;
    Oi = Os;
}
