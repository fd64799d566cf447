/* SPDX-License-Identifier: Apache-2.0
 * Macros of procedural textures of the early nineties. Written for Perigee to the names that published shaders expect. */
#ifndef PROCTEXT_H
#define PROCTEXT_H 1

#define boxstep(a, b, x) (clamp(((x) - (a)) / ((b) - (a)), 0, 1))
#define pulse(a, b, x) (step((a), (x)) - step((b), (x)))
#define bias(b, x) pow((x), log(b) / log(.5))
#define gain(g, x) (((x) < .5) ? bias(1 - (g), 2 * (x)) / 2 : 1 - bias(1 - (g), 2 - 2 * (x)) / 2)
#define snoise(x) (2 * noise(x) - 1)
#define snoise2(x, y) (2 * noise((x), (y)) - 1)
#define vnoise(x) noise(x)
#define MINFILTERWIDTH 1.0e-7
#define filterwidth(x) max(abs(Du(x) * du) + abs(Dv(x) * dv), MINFILTERWIDTH)
#define filterwidthp(p) max(sqrt(area(p)), MINFILTERWIDTH)

#endif
