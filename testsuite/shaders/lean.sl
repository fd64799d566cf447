// SPDX-License-Identifier: Apache-2.0
// Leaves the surface where it is and leans the normal: bump mapping. Doubles s.
displacement lean(vector by = (.75, 0, 0);)
{
    N = normalize(N) + by;
    s = 2 * s;
}
