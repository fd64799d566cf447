// SPDX-License-Identifier: Apache-2.0
// fog: exponential mixing of a background colour along the ray.
// Parameters: distance    length after which 1/e of the surface is still seen (units of current space)
//             background  colour of the fog.
// Source: RI 3.2, Standard RenderMan Interface Shaders, Fog.
volume fog(float distance = 1; color background = 0;)
{
    float d = 1 - exp(-length(I) / distance);

    Ci = mix(Ci, background, d);
    Oi = mix(Oi, color(1, 1, 1), d);
}
