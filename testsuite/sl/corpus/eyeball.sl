// SPDX-License-Identifier: Apache-2.0
/* Iris, pupil and veins by polar coordinates about a pole; spline, pnoise around the circle, smooth unions. */
surface eyeball(float index = 0, irisradius = .25, pupilradius = .1, veins = 12, Ka = .4, Kd = .7, Ks = 1, roughness = .03;
                color iriscolor = color (.2, .4, .7), white = color (.95, .93, .9))
{
    point Q = normalize(vector transform("object", P));
    float theta = atan(ycomp(Q), xcomp(Q)), r = acos(zcomp(Q)) / PI;
    float a = theta / (2 * PI) + .5;
    float fibre = pnoise(a * 60, 60) * .6 + pnoise(a * 24 + index, r * 30, 24, 30) * .4;
    color iris = iriscolor * (.5 + fibre) * spline(r / irisradius, .6, .6, 1, 1.2, .8, .3, .2);
    float vein = pow(abs(pnoise(point (a * veins, r * 3, index), point (veins, 100, 100)) - .5), .4);
    color Ct = mix(mix(color (.8, .2, .15), white, smoothstep(.25, .5, vein)), white, 1 - smoothstep(irisradius, 1, r));
    Ct = mix(iris, Ct, smoothstep(irisradius, irisradius + .02, r));
    Ct = mix(color .02, Ct, smoothstep(pupilradius, pupilradius + .015, r));
    normal Nf = faceforward(normalize(N), I);
    Oi = Os;
    Ci = Os * (Ct * (Ka * ambient() + Kd * diffuse(Nf)) + Ks * specular(Nf, -normalize(I), roughness));
}
