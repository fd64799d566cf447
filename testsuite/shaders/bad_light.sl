// SPDX-License-Identifier: Apache-2.0
// Cl is infinity less infinity.
light bad_light(uniform float huge = 1e30;)
{
    solar(vector (0, 0, 1), 0) {
        Cl = huge * huge - huge * huge;
    }
}
