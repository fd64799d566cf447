// SPDX-License-Identifier: Apache-2.0
/* A stack of textures: names, projections, spaces and 4x4 matrices as arrays, a loop over layers, string switches. */
#include "project.h"
#include "material.h"
#define MAXLAYERS 3
color apply_layer(color Cin; string name, operation; float ss, tt, ds, dt; float opacity)
{
    color C = Cin, Ct;
    float a;
    if (name == "grid") {
        Ct = color (mod(floor(ss * 8) + floor(tt * 8), 2), .2, .1);
        a = 1;
    } else {
        Ct = color texture(name, ss, tt, ss + ds, tt, ss, tt + dt, ss + ds, tt + dt, "filter", "gaussian", "fill", 1);
        a = float texture(name[3], ss, tt, "fill", 1);
    }
    a *= opacity;
    if (operation == "over")
        C = (1 - a) * Cin + a * Ct;
    else if (operation == "multiply")
        C = Cin * mix(color 1, Ct, a);
    else if (operation == "add")
        C += a * Ct;
    return C;
}
surface layered_signs(float Ka = 1, Kd = .7, Ks = .2, roughness = .1;
                      string names[MAXLAYERS] = {"grid", "", ""};
                      string projections[MAXLAYERS] = {"st", "spherical", "cylindrical"};
                      string spaces[MAXLAYERS] = {"shader", "shader", "object"};
                      string operations[MAXLAYERS] = {"over", "multiply", "add"};
                      float amount[MAXLAYERS] = {1, .5, .5};
                      float mx0[16] = {1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1};)
{
    uniform float i;
    color Ct = Cs;
    matrix m0 = array_to_mx(mx0);
    for (i = 0; i < MAXLAYERS; i += 1) {
        if (names[i] != "") {
            float ss, tt, ds, dt;
            ProjectTo2D(projections[i], P, spaces[i], m0, ss, tt, ds, dt);
            Ct = apply_layer(Ct, names[i], operations[i], ss, tt, ds, dt, amount[i]);
        }
    }
    normal Nf = faceforward(normalize(N), I);
    Oi = Os;
    Ci = Os * MaterialPlastic(Nf, Ct, Ka, Kd, Ks, roughness);
}
