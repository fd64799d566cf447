/* SPDX-License-Identifier: Apache-2.0
 * A ray and a sphere about the origin. Written for Perigee to the names that published shaders expect. */
#ifndef RAYSPHERE_H
#define RAYSPHERE_H 1

/* Number of meetings beyond eps; t0 and t1 are the distances in units of I, the nearer first. */
float raysphere(point E; vector I; float r; float eps; output float t0, t1)
{
    float solutions;
    float b = 2 * ((vector E) . I);
    float c = (vector E) . (vector E) - r * r;
    float discrim = b * b - 4 * c;
    if (discrim > 0) {
        discrim = sqrt(discrim);
        t0 = (-discrim - b) / 2;
        t1 = (discrim - b) / 2;
        solutions = (t0 > eps) + (t1 > eps);
        if (t0 <= eps)
            t0 = t1;
    } else if (discrim == 0) {
        t0 = -b / 2;
        t1 = t0;
        solutions = (t0 > eps) ? 1 : 0;
    } else {
        solutions = 0;
    }
    return solutions;
}

#endif
