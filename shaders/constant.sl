// SPDX-License-Identifier: Apache-2.0
// constant: the colour of the object, independent of any light.
// Parameters: none. Units: radiosity as given by Color.
// Source: RI 3.2, Standard RenderMan Interface Shaders, Constant Surface.
surface constant()
{
    Oi = Os;
    Ci = Os * Cs;
}
