// SPDX-License-Identifier: Apache-2.0
// Writes (s, t, 0) as the colour.
surface show_st()
{
    Oi = 1;
    Ci = color(s, t, 0);
}
