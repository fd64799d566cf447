/* SPDX-License-Identifier: Apache-2.0
 * Mirror reflection from rays or an environment map.
 * Written for Perigee to the names that published shaders expect. */
#ifndef REFLECTIONS_H
#define REFLECTIONS_H 1

#include "rayserver.h"

#define ENVPARAMS envname, envspace, envrad
#define DECLARE_ENVPARAMS string envname, envspace; uniform float envrad
#define DECLARE_DEFAULTED_ENVPARAMS string envname = "", envspace = "world"; uniform float envrad = 100

/* Direction from the middle of a sphere of radius envrad to where the ray from P along R leaves it. */
vector direction_on_sphere(point P; vector R; uniform float envrad)
{
    float b = 2 * (R . (P - point 0)), c = (P - point 0) . (P - point 0) - envrad * envrad;
    float d = b * b - 4 * c;
    return (d < 0) ? R : (P - point 0) + ((-b + sqrt(max(d, 0))) / 2) * R;
}

color Environment(point P; vector R; float blur; DECLARE_ENVPARAMS; output float alpha)
{
    color C = 0;
    alpha = 1;
    if (envname != "") {
        point Psp = transform(envspace, P);
        vector Rsp = normalize(vtransform(envspace, R));
        if (envrad != 0)
            Rsp = direction_on_sphere(Psp, Rsp, envrad);
        C = color environment(envname, Rsp, "blur", blur);
        alpha = float environment(envname[3], Rsp, "blur", blur, "fill", 1);
    }
    return C;
}

/* A map in the space of the picture, for flat mirrors. */
color ReflMap(point P; string reflname; float blur; output float alpha)
{
    point Pndc = transform("NDC", P);
    float x = xcomp(Pndc), y = ycomp(Pndc);
    alpha = float texture(reflname[3], x, y, "blur", blur, "fill", 1);
    return color texture(reflname, x, y, "blur", blur);
}

color SampleEnvironment(point P; vector R; float Kr, blur; DECLARE_ENVPARAMS)
{
    color C = 0;
    float alpha = 0;
    if (Kr > .0001) {
        if (envname == "" || envname == "reflection") {
            C = trace(P, R);
        } else if (envspace == "NDC") {
            C = ReflMap(P, envname, blur, alpha);
        } else {
            C = Environment(P, R, blur, ENVPARAMS, alpha);
        }
    }
    return Kr * C;
}

#endif
