// SPDX-License-Identifier: Apache-2.0
/* Turbulence by hand in a while loop, a spline with many knots given as an array. */
surface blue_marble(float Ks = .4, Kd = .6, Ka = .1, roughness = .1, txtscale = 1; color specularcolor = 1;
                    color veins[9] = {(.25,.25,.35), (.25,.25,.35), (.10,.10,.30), (.10,.10,.30), (.10,.10,.30),
                                      (.25,.25,.35), (.25,.25,.35), (.05,.05,.20), (.15,.15,.26)};)
{
    point PP = txtscale * transform("shader", P);
    normal Nf = faceforward(normalize(N), I);
    vector V = normalize(-I);
    float turb = 0, scale = 1, width = sqrt(area(PP));
    while (scale > width * 2 && scale > .01) {
        turb += scale * abs(.5 - noise(PP / scale));
        scale /= 2;
    }
    float csp = clamp(4 * turb - 3 * .25, 0, 1);
    color Ct = spline(csp, veins);
    Ci = Os * (Ct * (Ka * ambient() + Kd * diffuse(Nf)) + specularcolor * Ks * specular(Nf, V, roughness));
    Oi = Os;
}
