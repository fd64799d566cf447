// SPDX-License-Identifier: Apache-2.0
// rule: A function nobody defines is an error that names it and says how functions of DSOs are found; DSOs are opened from
//   directories the user names and nowhere else.
// spec: docs/shadeops.md
// run: slc {case}
// run forms: slc --shadeops {build}/runtime/base/test {case}
// exit: 1
// exit forms: 1
// message: unknown.sl:@a:\d+: error: function 'dsosum' is not defined; if it is a function of a DSO, .*--shadeops
// message: unknown.sl:@a:\d+: error: no form of 'dsosum' takes \(string\); forms: f\(f,f\) c\(c,c\)
// quiet: dsobroken
surface unknown()
{
    Ci = dsosum("text"); // @a
}
