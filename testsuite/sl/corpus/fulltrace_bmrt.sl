// SPDX-License-Identifier: Apache-2.0
/* All ray functions of BMRT: fulltrace with its outputs, visibility, rayhittest, level and shadow tests; old outputs as point. */
#include "rayserver.h"
surface fulltrace_bmrt(float Kr = .8, Kd = .4; string envname = ""; color sky = color (.2, .3, .6))
{
    point Nf = faceforward(normalize(N), I);
    point R = reflect(normalize(I), Nf);
    point Phit, Pmiss;
    vector Nhit, Rmiss;
    color hit;
    float hitdist, level;
    color Crefl = 0;
#if (defined(BMRT) || defined(RAYSERVER_H))
    if (raylevel() < 3 && isshadowray() != 1) {
        level = fulltrace(P, R, hit, hitdist, Phit, Nhit, Pmiss, Rmiss);
        Crefl = hit;
        if (level > 0 || hitdist > 1.0e10)
            Crefl += envname != "" ? color environment(envname, vtransform("world", Rmiss)) : sky;
        if (hitdist < 1.0e10)
            Crefl *= 1 / (1 + .01 * hitdist);
    }
    color open = visibility(P, P + 10 * Nf);
    point ph; vector nh;
    float dist = rayhittest(P, Nf, ph, nh);
    Crefl *= transmission(P, P + R) * open;
    if (dist < 1)
        Crefl *= dist;
#endif
    Oi = Os;
    Ci = Os * (Cs * Kd * diffuse(Nf) + Kr * Crefl);
}
