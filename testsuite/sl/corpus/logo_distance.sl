// SPDX-License-Identifier: Apache-2.0
/* A logo from primitives: disks, capsules by ptlined, a superellipse, a bezier curve by sampling; antialiased union. */
#include "patterns.h"
float capsule(float x, y, x0, y0, x1, y1, r)
{
    return r - ptlined(point (x0, y0, 0), point (x1, y1, 0), point (x, y, 0));
}
float bezier_distance(float x, y; point k[4])
{
    uniform float i;
    float best = 1e6;
    for (i = 0; i <= 16; i += 1) {
        point q = spline("bezier", i / 16, k);
        best = min(best, distance(q, point (x, y, 0)));
    }
    return best;
}
surface logo_distance(color ink = color (.1, .2, .6), second = color (.9, .3, .1); float Kd = 1)
{
    point curve[4] = {(.15, .2, 0), (.3, .9, 0), (.7, -.3, 0), (.85, .6, 0)};
    float fw = max(filterwidth(s), filterwidth(t));
    float d1 = max(capsule(s, t, .2, .8, .8, .8, .05), capsule(s, t, .5, .8, .5, .2, .05));
    float d2 = .03 - bezier_distance(s, t, curve);
    float d3 = 1 - pow(pow(abs(s - .5) / .48, 4) + pow(abs(t - .5) / .48, 4), .25);
    float in1 = smoothstep(-fw, fw, d1), in2 = smoothstep(-fw, fw, d2), border = 1 - smoothstep(.03, .03 + 2 * fw, abs(d3));
    float all = union(in1, border);
    color Ct = blend(blend(Cs, ink, all), second, in2);
    Oi = Os;
    Ci = Os * Ct * (.2 + Kd * diffuse(faceforward(normalize(N), I)));
}
