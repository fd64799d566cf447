// SPDX-License-Identifier: Apache-2.0
// ambientlight: the same light everywhere, from no direction.
// Parameters: intensity   factor on lightcolor
//             lightcolor  colour of the light.
// Units: Cl is what ambient() adds. Source: RI 3.2, Standard RenderMan Interface Shaders, Ambient Light.
light ambientlight(float intensity = 1; color lightcolor = 1;)
{
    Cl = intensity * lightcolor;
}
