// SPDX-License-Identifier: Apache-2.0
// bumpy: moves the surface along its normal by a texture.
// Parameters: amplitude    height where the texture is 1 (units of current space)
//             texturename  height texture over s, t; "" moves nothing.
// Source: RI 3.2, Standard RenderMan Interface Shaders, Bumpy.
displacement bumpy(float amplitude = 1; string texturename = "";)
{
    if (texturename != "") {
        float height = amplitude * float texture(texturename, s, t);
        P += height * normalize(N);
        N = calculatenormal(P);
    }
}
