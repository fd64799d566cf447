// SPDX-License-Identifier: Apache-2.0
// rule: An unknown function close to a known one gets a hint.
// spec: RI 3.2, Shading Language
// exit: 1
// message: error_spelling\.sl:@here:\d+: error: .*normalise
// timeout: 30
// expect: len([line for line in messages if "normalize" in line]) >= 1
surface error_spelling()
{
    vector v = normalise(I); // @here
    Ci = color(xcomp(v), 0, 0);
}
