// SPDX-License-Identifier: Apache-2.0
/* Solid wood: noise along a distorted axis, user coordinate system by name, depth cue by eye distance. */
#include "patterns.slh"
surface wood_rings(float ringscale = 10, grain = 5; color lightwood = color (0.3, 0.12, 0.03),
                   darkwood = color (0.05, 0.01, 0.005); string space = "marble"; float Ka = .2, Kd = .4;)
{
    point PP = transform(space, P);
    point Q = transform("current", "object", P) * ringscale;
    float y, z, r;
    PP += noise(PP);
    y = ycomp(PP); z = zcomp(PP);
    r = sqrt(y * y + z * z) * ringscale;
    r += abs(snoise(r)) * .1;
    r -= floor(r);
    r = smoothstep(0, .8, r) - smoothstep(.83, 1, r);
    color C = mix(lightwood, darkwood, r);
    float g = smoothstep(.2, 1, r * mod(noise(xcomp(Q) * grain, ycomp(Q)), 1));
    normal NN = faceforward(normalize(N), I);
    Oi = Os;
    Ci = Oi * C * (1 - .2 * g) * (Ka + Kd * diffuse(NN)) * (1 - .5 * depth(P));
}
