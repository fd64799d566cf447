/* SPDX-License-Identifier: Apache-2.0
 * A volume that absorbs by exp(-density d), and glows by emission per unit of length. */
volume absorbing(float density = 1; color emission = 0)
{
    float through = exp(-density * length(I));
    Ci = Ci * through + emission * (1 - through) / density;
    Oi = Oi * through + (1 - through);
}
