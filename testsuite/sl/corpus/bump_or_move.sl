// SPDX-License-Identifier: Apache-2.0
displacement bump_or_move(float height = .1; uniform float truedisp = 1; string mapname = "";)
{
    float h = (mapname != "") ? height * float texture(mapname[0], s, t, "blur", .01, "filter", "gaussian") : 0;
    normal NN = normalize(N);
    if (truedisp != 0) {
        P += h * NN;
        N = calculatenormal(P);
    } else
        N = calculatenormal(P + h * NN);
}
