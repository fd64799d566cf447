// SPDX-License-Identifier: Apache-2.0
// Red is no number in the lower half of a picture of 16 lines.
imager bad_imager()
{
    float below = step(8, ycomp(P));
    color bad = color(below / (1 - below) * 0, 0, 0);
    Ci += bad;
}
