// SPDX-License-Identifier: Apache-2.0
// For a sphere about `center` (camera space) that swell has made larger: r |P - center| - radius, g angle between N and
// the radius (as 1 - cos), b the same for I and P.
surface swollen_error(point center = (0, 0, 5); float radius = 1;)
{
    vector out = P - center;
    Oi = 1;
    Ci = color(length(out) - radius, 1 - normalize(out) . normalize(N), length(I - P));
}
