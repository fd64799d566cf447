// SPDX-License-Identifier: Apache-2.0
/* Environments in all forms, shadows in a surface, textureinfo with every kind of result. */
surface environment_forms(string envmap = "", shadowmap = ""; float Kr = .5)
{
    normal Nf = faceforward(normalize(N), I);
    vector R = vtransform("world", reflect(normalize(I), Nf));
    color a = environment(envmap, R);
    color b = color environment(envmap, R, "blur", .1, "samples", 4, "filter", "gaussian");
    float c = environment(envmap[1], R, "width", 1);
    color d = environment(envmap, R, R + .01, R - .01, R * 2, "fill", .5);
    float in_shadow = shadow(shadowmap, P, "bias", .01) + shadow(shadowmap[0], P, P, P, P, "samples", 4);
    uniform float res[2] = {0, 0};
    uniform float chans = 0;
    uniform string kind = "none";
    matrix view;
    float proj[16];
    uniform float found = textureinfo(envmap, "resolution", res) + textureinfo(envmap, "channels", chans)
        + textureinfo(envmap, "type", kind) + textureinfo(shadowmap, "viewingmatrix", view)
        + textureinfo(shadowmap, "projectionmatrix", proj) + textureinfo(envmap, "exists", 0);
    Oi = Os;
    Ci = Os * (Cs * diffuse(Nf) * (1 - in_shadow) + Kr * (a + b + c + d) / 4 + found * res[0] * chans * 0);
    if (kind == "latlong")
        Ci *= 1;
}
