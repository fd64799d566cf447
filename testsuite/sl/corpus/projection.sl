// SPDX-License-Identifier: Apache-2.0
// Projection through matrices, texture channels and queries.
surface projection(string mapname = ""; string maps[2] = {"", ""}; uniform float chan = 1)
{
    uniform float found, res[2] = {0, 0};
    uniform matrix cam = 1, scr = 1;
    uniform string kind = "none";
    found = textureinfo(mapname, "resolution", res);
    textureinfo(mapname, "viewingmatrix", cam);
    if (textureinfo(mapname, "exists", 0) == 1)
        textureinfo(mapname, "type", kind);
    point Pp = transform(scr * cam, transform("world", "current", transform("world", P)));
    point Pn = transform("NDC", P);
    float a = 0;
    if (found != 0)
        a = float texture(mapname[chan], xcomp(Pp), ycomp(Pp)) * texture(maps[1][2], s, t);
    color c = texture("fixed" ".tx", 0, 0, 1, 0, 0, 1, 1, 1);
    Ci = c * a + color (xcomp(Pn), ycomp(Pn), res[0] / max(res[1], 1)) + (kind == "texture" ? color (1, 0, 0) : 0);
    Oi = 1;
}
