// SPDX-License-Identifier: Apache-2.0
// null: changes nothing. The surface keeps the colour and opacity of the object (Ci = Cs, Oi = Os on entry).
// Parameters: none. Where another kind of shader is named "null" the renderer runs none at all.
// Source: RI 3.2, Standard RenderMan Interface Shaders.
surface null()
{
}
