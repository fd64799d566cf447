// SPDX-License-Identifier: Apache-2.0
// rule: A string without end is an error with a place.
// spec: RI 3.2, Shading Language
// exit: 1
// message: hostile_string\.sl:\d+:\d+: error: 
// quiet: missing terminating
// timeout: 30
surface hostile_string()
{
    printf("no end);
}
