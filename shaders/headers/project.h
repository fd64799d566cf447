/* SPDX-License-Identifier: Apache-2.0
 * Projections from a point of space to texture coordinates, with the widths over which they change.
 * Written for Perigee to the names that published shaders expect. */
#ifndef PROJECT_H
#define PROJECT_H 1

#include "filterwidth.h"

matrix array_to_mx(float m[16])
{
    return matrix (m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7],
                   m[8], m[9], m[10], m[11], m[12], m[13], m[14], m[15]);
}

/* Spherical coordinates about z, in units of the full circle and the half circle. */
void spherical_projection(point p; output float ss, tt, ds, dt)
{
    extern float du, dv;
    vector V = normalize(vector p);
    ss = (-atan(ycomp(V), xcomp(V)) + PI) / (2 * PI);
    tt = .5 - acos(zcomp(V)) / PI;
    ds = filterwidth(ss);
    if (ds > .5)
        ds = max(1 - ds, MINFILTERWIDTH);
    dt = filterwidth(tt);
}

void cylindrical_projection(point p; output float ss, tt, ds, dt)
{
    extern float du, dv;
    vector V = normalize(vector p);
    ss = (-atan(ycomp(V), xcomp(V)) + PI) / (2 * PI);
    tt = zcomp(p);
    ds = filterwidth(ss);
    if (ds > .5)
        ds = max(1 - ds, MINFILTERWIDTH);
    dt = filterwidth(tt);
}

/* projection: "st", "planar", "perspective", "spherical" or "cylindrical". */
void ProjectTo2D(string projection; point P; string whichspace; matrix xform; output float ss, tt, ds, dt)
{
    extern float s, t, du, dv;
    point Pproj;
    if (projection == "st") {
        Pproj = point (s, t, 0);
    } else {
        Pproj = transform(whichspace, P);
    }
    Pproj = transform(xform, Pproj);
    if (projection == "perspective") {
        float z = max(zcomp(Pproj), 1e-6);
        ss = xcomp(Pproj) / z;
        tt = ycomp(Pproj) / z;
        ds = filterwidth(ss);
        dt = filterwidth(tt);
    } else if (projection == "spherical") {
        spherical_projection(Pproj, ss, tt, ds, dt);
    } else if (projection == "cylindrical") {
        cylindrical_projection(Pproj, ss, tt, ds, dt);
    } else {
        ss = xcomp(Pproj);
        tt = ycomp(Pproj);
        ds = filterwidth(ss);
        dt = filterwidth(tt);
    }
}

#endif
