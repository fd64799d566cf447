// SPDX-License-Identifier: Apache-2.0
/* Light from a piece of geometry, bent to the facing side; reads u, v and N of the emitter. */
light area_soft(float intensity = 1; color lightcolor = 1; string texturename = "";)
{
    N = normalize(N);
    illuminate (P, N, PI / 2) {
        color c = lightcolor;
        if (texturename != "")
            c *= color texture(texturename, u, v);
        Cl = (intensity / (L . L)) * c * max(0, N . normalize(L));
    }
}
