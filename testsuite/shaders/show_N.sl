// SPDX-License-Identifier: Apache-2.0
// Writes the unit shading normal, camera space, as the colour.
surface show_N()
{
    normal n = ntransform("camera", normalize(N));
    Oi = 1;
    Ci = color(xcomp(n), ycomp(n), zcomp(n));
}
