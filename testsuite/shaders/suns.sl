// SPDX-License-Identifier: Apache-2.0
// Light straight along the view from a disc of directions.
light suns(float angle = 0;)
{
    solar(vector "shader" (0, 0, 1), angle)
        Cl = 1;
}
