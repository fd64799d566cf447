// SPDX-License-Identifier: Apache-2.0
// A loop that does not end where u < .5: half of each packet goes on.
surface endless_spots()
{
    float i = 0;
    Oi = 1;
    Ci = 0;
    while (u < .5 || i < 100)
        i += 1;
    Ci = color(1, 1, 1) * i / 100;
}
