// SPDX-License-Identifier: Apache-2.0
// Compares Cs with the affine function of object-space position that the case gave at the vertices:
// (x, y, x/4 + y/2). Writes the error of each channel.
surface ramp_error()
{
    point p = transform("object", P);
    color want = color(xcomp(p), ycomp(p), xcomp(p) / 4 + ycomp(p) / 2);
    Oi = 1;
    Ci = color(abs(comp(Cs, 0) - comp(want, 0)), abs(comp(Cs, 1) - comp(want, 1)), abs(comp(Cs, 2) - comp(want, 2)));
}
