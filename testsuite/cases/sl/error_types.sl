// SPDX-License-Identifier: Apache-2.0
// rule: A string cannot become a colour; a matrix cannot be added to a float.
// spec: RI 3.2, Shading Language
// exit: 1
// message: error_types\.sl:@one:\d+: error: 
// message: error_types\.sl:@two:\d+: error: 
// timeout: 30
surface error_types()
{
    Ci = "red"; // @one
    float x = matrix 1 + 1; // @two
}
