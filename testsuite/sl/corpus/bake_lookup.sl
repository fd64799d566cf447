// SPDX-License-Identifier: Apache-2.0
/* Baking and point clouds with outputs, rayinfo and attribute queries; in all of them nothing may be there. */
surface bake_lookup(string bakefile = "", cloud = ""; output varying color _indirect = 0; output varying float _occ = 0;)
{
    normal Nf = faceforward(normalize(N), I);
    color d = diffuse(Nf);
    if (bakefile != "") {
        bake(bakefile, s, t, d);
        bake(concat(bakefile, ".z"), s, t, zcomp(P));
    }
    if (cloud != "") {
        float ok = texture3d(cloud, P, Nf, "_indirect", _indirect, "_occ", _occ);
        if (ok == 0)
            ok = bake3d(cloud, "_indirect,_occ", P, Nf, "_indirect", d, "_occ", .5, "interpolate", 1);
    }
    uniform float rate = 1, depthlevel = 0;
    uniform string who = "";
    uniform matrix to;
    attribute("ShadingRate", rate);
    attribute("identifier:name", who);
    rayinfo("depth", depthlevel);
    string kind = "camera";
    rayinfo("type", kind);
    _occ = occlusion(P, Nf, 8, "maxdist", 5);
    Ci = Os * Cs * (d + _indirect) * (kind == "camera" ? 1 : .9) * (who == "nobody" ? 0 : 1);
    Oi = Os;
}
