// SPDX-License-Identifier: Apache-2.0
// Arrays: initialisers, unsized formals, varying index, whole copies, parameters set from RIB.
#define N_COLORS 5
color pick(color palette[]; float where)
{
    float index = where * arraylength(palette);
    return palette[index];
}
void fill(output float table[4]; float from)
{
    float i;
    for (i = 0; i < 4; i += 1)
        table[i] = from + i;
}
surface arrays(float mx[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
               color ramp[N_COLORS] = {(1, 0, 0), (0, 1, 0), (0, 0, 1), 1, color "hsv" (.5, 1, 1)};
               string names[2] = {"first", "second"};
               float weights[] = {.25, .5, .25})
{
    float table[4], copy[4];
    fill(table, s);
    copy = table;
    copy[2] += weights[1] * 2;
    float x = spline(t, copy);
    color c = spline("linear", s, ramp);
    string n = names[t * 2];
    if (n == "second" && names[0] != n)
        c *= pick(ramp, s);
    Ci = c * (x + mx[0] * mx[5] + copy[9]);
    Oi = 1;
}
