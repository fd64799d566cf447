// SPDX-License-Identifier: Apache-2.0
// An atmosphere with outputs: the depth it saw, and the colour of the surface before it.
volume fog_output(output varying float far = 0; output varying color Cdiffuse = 0;)
{
    far = length(I);
    Cdiffuse = Ci * .5;
    Ci = color(0, 0, 1);
}
