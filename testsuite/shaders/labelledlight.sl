// SPDX-License-Identifier: Apache-2.0
// A distant light along z with a category.
light labelledlight(string __category = "";)
{
    solar(vector "world" (0, 0, 1), 0)
        Cl = 1;
}
