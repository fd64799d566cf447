// SPDX-License-Identifier: Apache-2.0
// Assigns L, adds to Cl and to its outputs: all three must start anew at each execution.
light bentlight(float intensity = .25; vector way = vector "world" (.6, 0, .8); output varying float runs = 0;
                output uniform float __nonspecular = 1;)
{
    runs += 1;
    illuminate (point "shader" (0, 0, 0)) {
        L = 2 * way;
        Cl += intensity;
    }
    Cl *= 2;
}
