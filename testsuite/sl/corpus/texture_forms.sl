// SPDX-License-Identifier: Apache-2.0
/* Every way to ask for a texture: with and without coordinates, channels, four corners, options, casts, functions. */
float alpha_of(string name; float ss, tt) { return texture(name[3], ss, tt, "fill", 1); }
surface texture_forms(string map = ""; string maps[2] = {"", ""}; uniform float channel = 1; float blur = .01)
{
    color a = texture(map);
    color b = color texture(map, s, t) * color texture(maps[1], s, t, "blur", blur);
    float c = texture(map[channel], s * 2, t * 2, "width", .5, "filter", "box");
    float d = float texture(maps[0][2], 1 - s, t, "swidth", 2, "twidth", 1, "lerp", 1);
    color e = texture(map, s, t, s + .1, t, s, t + .1, s + .1, t + .1, "sblur", .1, "tblur", 0);
    float f = alpha_of(map, s, t);
    s *= 3;
    color g = texture(map, "filter", "gaussian", "samples", 8);
    if (map != "")
        a *= color texture(concat(map, ".tx"));
    Oi = Os;
    Ci = Os * Cs * (a + b + c + d + e + f + g) / 5 * (.2 + diffuse(normalize(faceforward(N, I))));
}
