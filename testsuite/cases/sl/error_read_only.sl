// SPDX-License-Identifier: Apache-2.0
// rule: P cannot be assigned in a light, Cl not in a displacement.
// spec: RI 3.2, Shading Language
// exit: 1
// message: error_read_only\.sl:@here:\d+: error: .*P
// timeout: 30
light error_read_only()
{
    P = point(0, 0, 0); // @here
    Cl = 1;
}
