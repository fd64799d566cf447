// SPDX-License-Identifier: Apache-2.0
// rule: Assigning a variable that this kind of shader may only read is a warning with its place, and a local copy is
//   assigned, as for formals that are not output: the specification calls both read-only, renderers differ, and
//   published shaders do it (slc-007 in docs/design/slc.md).
// spec: RI 3.2, Shading Language; a documented deviation
// exit: 0
// message: error_read_only\.sl:@here:\d+: warning: 'P' is read-only .*local copy
// timeout: 30
light error_read_only()
{
    P = point(0, 0, 0); // @here
    Cl = 1;
}
