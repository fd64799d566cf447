// SPDX-License-Identifier: Apache-2.0
// Glass that lets red through and a quarter of green; only for shadow rays, to others it is opaque.
surface stained()
{
    Oi = 1;
    if (isshadowray() != 0)
        Oi = color(0, .75, 1);
    Ci = Oi * diffuse(N);
}
