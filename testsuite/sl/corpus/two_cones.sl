// SPDX-License-Identifier: Apache-2.0
/* Two illuminate statements under different conditions. */
light two_cones(float intensity = 1; uniform float which = 0; point from = point "shader" (0, 0, 0))
{
    if (which == 0) {
        illuminate(from, vector "shader" (0, 0, 1), PI / 6)
            Cl = intensity;
    } else {
        illuminate(from, vector "shader" (0, 0, -1), PI / 6)
            Cl = intensity / 2;
    }
}
