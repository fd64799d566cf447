// SPDX-License-Identifier: Apache-2.0
// Writes P in the named space as the colour.
surface show_P(string space = "camera";)
{
    point p = transform(space, P);
    Oi = 1;
    Ci = color(xcomp(p), ycomp(p), zcomp(p));
}
