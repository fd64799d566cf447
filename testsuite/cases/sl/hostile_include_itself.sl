// SPDX-License-Identifier: Apache-2.0
// rule: A file that includes itself ends with an error.
// spec: RI 3.2, Shading Language
// exit: 1
// message: hostile_include_itself\.sl:\d+(:\d+)?:? .*error: .*
// timeout: 30
// quiet: .*
#include "hostile_include_itself.sl"
surface hostile_include_itself() { }
