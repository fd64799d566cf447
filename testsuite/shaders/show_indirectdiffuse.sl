// SPDX-License-Identifier: Apache-2.0
// Ci = indirectdiffuse() of the side that is seen, or one of its outputs.
surface show_indirectdiffuse(float samples = 400; string show = "color", environmentmap = "";)
{
    normal n = faceforward(normalize(N), I);
    float covered = -1;
    vector open = 0;
    color c = indirectdiffuse(P, n, samples, "environmentmap", environmentmap, "occlusion", covered, "environmentdir", open);
    Oi = 1;
    Ci = c;
    if (show == "occlusion")
        Ci = covered;
    if (show == "environmentdir")
        Ci = color(comp(open, 0), comp(open, 1), comp(open, 2));
}
