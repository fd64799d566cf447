// SPDX-License-Identifier: Apache-2.0
// Writes the incident vector, camera space, as the colour.
surface show_I()
{
    vector d = vtransform("camera", I);
    Oi = 1;
    Ci = color(xcomp(d), ycomp(d), zcomp(d));
}
