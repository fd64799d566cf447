// SPDX-License-Identifier: Apache-2.0
// rule: Assigning a variable that this kind of shader may only read is reported with its place.
// spec: RI 3.2, Shading Language
// exit: 0 or 1
// message: error_read_only\.sl:@here:\d+: (warning|error): .*P
// timeout: 30
light error_read_only()
{
    P = point(0, 0, 0); // @here
    Cl = 1;
}
