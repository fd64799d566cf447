/* SPDX-License-Identifier: Apache-2.0
 * Widths of filters: how far a value moves from one sample to the next.
 * Written for Perigee to the names that published shaders expect. */
#ifndef FILTERWIDTH_H
#define FILTERWIDTH_H 1

#define MINFILTERWIDTH 1.0e-6
#define MINFILTWIDTH MINFILTERWIDTH

#define filterwidth(x) (max(abs(Du(x) * du) + abs(Dv(x) * dv), MINFILTERWIDTH))
#define filterwidthp(p) (max(sqrt(area(p)), MINFILTERWIDTH))

#endif
