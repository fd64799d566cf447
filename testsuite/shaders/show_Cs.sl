// SPDX-License-Identifier: Apache-2.0
// Writes Cs; in alpha the mean of Os, not applied to the colour.
surface show_Cs()
{
    Oi = Os;
    Ci = Cs;
}
