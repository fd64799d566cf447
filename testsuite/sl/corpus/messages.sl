// SPDX-License-Identifier: Apache-2.0
// warns: parameter 'who' is assigned a varying value
/* Message passing and state queries with all kinds of variables. */
surface messages(output varying color seen = 0; output uniform string who = "";)
{
    varying float dent = 0;
    uniform float rate = 1, format[3] = {0, 0, 1}, version[4] = {0, 0, 0, 0}, sides = 2;
    uniform string id = "none", renderer = "";
    varying color fogcolor = 0;
    if (displacement("depth_of_dent", dent) == 1)
        seen = dent;
    attribute("ShadingRate", rate);
    attribute("identifier:name", id);
    attribute("Ri:Sides", sides);
    option("Format", format);
    rendererinfo("renderer", renderer);
    rendererinfo("version", version);
    atmosphere("background", fogcolor);
    incident("color", fogcolor);
    opposite("color", fogcolor);
    who = format("%s/%s %04d %.2f", shadername(), id, version[0], rate);
    if (shadername("displacement") == "" && rayinfo("depth", rate) == 0)
        seen += fogcolor * format[2] * sides;
    Ci = seen;
    Oi = Os;
}
