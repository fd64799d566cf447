// SPDX-License-Identifier: Apache-2.0
/* Shows a texture as it is, with the options of a lookup as parameters. */
surface show_texture(string name = ""; float blur = 0, width = 1, fill = 0, channel = 0; string filter = "box";)
{
    Oi = 1;
    Ci = texture(name[channel], s, t, "blur", blur, "width", width, "fill", fill, "filter", filter);
}
