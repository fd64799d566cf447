// SPDX-License-Identifier: Apache-2.0
imager exposure_imager(float gain = 1, gamma = 1; color background = 0;)
{
    Ci += (1 - alpha) * background;
    Oi = 1;
    alpha = 1;
    setcomp(Ci, 0, pow(gain * comp(Ci, 0), 1 / gamma));
    setcomp(Ci, 1, pow(gain * comp(Ci, 1), 1 / gamma));
    setcomp(Ci, 2, pow(gain * comp(Ci, 2), 1 / gamma));
    if (mod(xcomp(P), 16) < 1 || mod(ycomp(P), 16) < 1)
        Ci *= .9;
}
