// SPDX-License-Identifier: Apache-2.0
// rule: A function that calls itself is an error, not an endless compilation.
// spec: RI 3.2, Shading Language
// exit: 1
// message: error_recursion\.sl:\d+:\d+: error: .*
// timeout: 30
float again(float x)
{
    return again(x - 1);
}

surface error_recursion()
{
    Ci = again(3);
}
