// SPDX-License-Identifier: Apache-2.0
// A point light that can stay out of diffuse() or specular().
light choosylight(float intensity = 1; point from = point "shader" (0, 0, 0); output float __nondiffuse = 0;
                  output float __nonspecular = 0;)
{
    illuminate(from)
        Cl = intensity / (L . L);
}
