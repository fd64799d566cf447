// SPDX-License-Identifier: Apache-2.0
// background: puts a colour behind everything; the picture becomes opaque.
// Parameters: bgcolor     the colour
//             background  the same under the name some libraries use; the two are multiplied.
// Exporters also write "color", which is a keyword here and no parameter name: the renderer binds it to bgcolor
// (docs/design/tracer.md).
// Source: RI 3.2, Imager shaders.
imager background(color bgcolor = 1; color background = 1;)
{
    Ci += (1 - alpha) * bgcolor * background;
    Oi = 1;
    alpha = 1;
}
