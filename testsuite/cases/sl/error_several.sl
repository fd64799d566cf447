// SPDX-License-Identifier: Apache-2.0
// rule: Several errors are reported in one run.
// spec: RI 3.2, Shading Language
// exit: 1
// message: error_several\.sl:@one:\d+: error: .*unknown_name
// message: error_several\.sl:@two:\d+: error: .*unknown_function
// timeout: 30
surface error_several()
{
    Ci = unknown_name; // @one
    Oi = unknown_function(1); // @two
}
