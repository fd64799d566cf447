// SPDX-License-Identifier: Apache-2.0
// Writes (|distance from the object's z axis - radius|, |N out of the radial direction|, 0).
surface radius_error(float radius = 1;)
{
    point p = transform("object", P);
    vector n = normalize(vector ntransform("object", N));
    vector out = normalize(vector(xcomp(p), ycomp(p), 0));
    Oi = 1;
    Ci = color(abs(sqrt(xcomp(p) * xcomp(p) + ycomp(p) * ycomp(p)) - radius), length(n ^ out), 0);
}
