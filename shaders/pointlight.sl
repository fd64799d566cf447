// SPDX-License-Identifier: Apache-2.0
// pointlight: light from one point in all directions, weaker with the square of the distance.
// Parameters: intensity   Cl at distance 1 (units of current space), factor on lightcolor
//             lightcolor  colour of the light
//             from        where it stands (shader space).
// Source: RI 3.2, Standard RenderMan Interface Shaders, Point Light.
light pointlight(float intensity = 1; color lightcolor = 1; point from = point "shader" (0, 0, 0);)
{
    illuminate(from)
        Cl = intensity * lightcolor / (L . L);
}
