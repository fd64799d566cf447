// SPDX-License-Identifier: Apache-2.0
// rule: An array of 2^31 elements is an error, not an allocation.
// spec: RI 3.2, Shading Language
// exit: 1
// message: hostile_array\.sl:\d+:\d+: error: 
// timeout: 30
surface hostile_array()
{
    float x[2147483648];
    float y[2147483647];
    x[0] = 1;
    y[1] = 2;
    Ci = x[0] + y[1];
}
