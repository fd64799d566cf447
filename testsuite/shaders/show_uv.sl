// SPDX-License-Identifier: Apache-2.0
// Writes (u, v, 0) as the colour.
surface show_uv()
{
    Oi = 1;
    Ci = color(u, v, 0);
}
