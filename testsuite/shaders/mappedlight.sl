// SPDX-License-Identifier: Apache-2.0
/* A point light whose shadows come from a map. */
light mappedlight(float intensity = 1; point from = point "shader" (0, 0, 0); string map = ""; float blur = 0, samples = 16;)
{
    illuminate (from)
        Cl = intensity * (1 - shadow(map, Ps, "blur", blur, "samples", samples));
}
