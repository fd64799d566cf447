// SPDX-License-Identifier: Apache-2.0
// rule: A string without end is an error with a place, told once (what the parser finds behind it may follow).
// spec: RI 3.2, Shading Language
// exit: 1
// message: hostile_string\.sl:\d+:\d+: error: 
// timeout: 30
surface hostile_string()
{
    printf("no end);
}
