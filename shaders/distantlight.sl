// SPDX-License-Identifier: Apache-2.0
// distantlight: parallel light from infinitely far away.
// Parameters: intensity   Cl of a surface facing the light, factor on lightcolor
//             lightcolor  colour of the light
//             from, to    the light travels along to - from (shader space).
// Source: RI 3.2, Standard RenderMan Interface Shaders, Distant Light.
light distantlight(float intensity = 1; color lightcolor = 1; point from = point "shader" (0, 0, 0);
                   point to = point "shader" (0, 0, 1);)
{
    solar(to - from, 0)
        Cl = intensity * lightcolor;
}
