// SPDX-License-Identifier: Apache-2.0
// defaultsurface: what an object without a surface shader looks like: matte under a lamp at the eye, so that it
// is seen whatever the lights are.
// Parameters: Ka, Kd  parts of light from everywhere and from the eye, 0..1.
// Source: RI 3.2 leaves the default surface open; the formula and its values are ours.
surface defaultsurface(float Ka = .2; float Kd = .8;)
{
    float facing = abs(normalize(I) . normalize(N));

    Oi = Os;
    Ci = Os * Cs * (Ka + Kd * facing);
}
