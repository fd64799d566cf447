// SPDX-License-Identifier: Apache-2.0
// Writes the unit geometric normal, camera space, as the colour.
surface show_Ng()
{
    normal n = normalize(ntransform("camera", Ng));
    Oi = 1;
    Ci = color(xcomp(n), ycomp(n), zcomp(n));
}
