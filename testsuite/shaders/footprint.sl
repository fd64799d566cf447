/* SPDX-License-Identifier: Apache-2.0
 * Shows how far the next shading sample is, across the ray. */
surface footprint()
{
    float along = normalize(I) . normalize(dPdu);
    Oi = 1;
    Ci = du * length(dPdu) * sqrt(1 - along * along);
}
