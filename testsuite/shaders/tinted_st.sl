// SPDX-License-Identifier: Apache-2.0
/* s, t and the blue of the colour. */
surface tinted_st()
{
    Oi = 1;
    Ci = color(s, t, comp(Cs, 2));
}
