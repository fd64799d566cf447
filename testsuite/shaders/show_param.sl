// SPDX-License-Identifier: Apache-2.0
// Writes its parameters as the colour: (amount, xcomp of where in camera space, first of table).
surface show_param(float amount = .125; point where = point "shader" (0, 0, 0); float table[2] = {.5, .25};
                   varying color tint = color(0, 0, 0); float pick = 0;)
{
    Oi = 1;
    if (pick == 0)
        Ci = color(amount, xcomp(where), table[0]);
    else if (pick == 1)
        Ci = color(xcomp(where), ycomp(where), zcomp(where));
    else
        Ci = tint;
}
