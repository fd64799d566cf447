// SPDX-License-Identifier: Apache-2.0
/* A switch over strings, uniform, with a default branch and messages. */
surface string_switch(string mode = "flat"; string mapname = ""; float debug = 0)
{
    color Ct = Cs;
    if (mode == "flat") {
        Ct = Cs;
    } else if (mode == "noise") {
        Ct *= float noise(10 * transform("object", P));
    } else if (mode == "cells")
        Ct = color cellnoise(s * 10, t * 10);
    else if (mode == "map") {
        if (mapname != "")
            Ct *= color texture(mapname);
        else
            printf("string_switch: mode \"map\" needs a name, " "not %s\n", mapname);
    } else
        printf("string_switch: mode %s is unknown (%d)\n", mode, debug);
    if (match("^fl", mode) != 0 || concat(mode, "s") == "cellss")
        Ct *= .5;
    Oi = Os;
    Ci = Oi * Ct;
}
