// SPDX-License-Identifier: Apache-2.0
// Assigns L inside illuminate to fake parallel rays, like the larger production lights.
light parallel_light(float intensity = 1; uniform float parallel = 1; point from = point "shader" (0, 0, 0);)
{
    vector axis = vector "shader" (0, 0, 1);
    illuminate(from) {
        if (parallel != 0)
            L = axis * length(Ps - from);
        Cl = intensity;
        Ol = 1;
    }
}
