// SPDX-License-Identifier: Apache-2.0
/* Shows the light that arrives, whatever its direction. */
surface show_light()
{
    color C = 0;
    illuminance (P)
        C += Cl;
    Oi = 1;
    Ci = C;
}
