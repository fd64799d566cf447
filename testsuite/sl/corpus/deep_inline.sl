// SPDX-License-Identifier: Apache-2.0
// Functions calling functions with outputs, array elements as outputs, conversions on the way back.
void split3(vector v; output float x, y, z) { x = xcomp(v); y = ycomp(v); z = zcomp(v); }
void order(output float a, b) { if (a > b) { float c = a; a = b; b = c; } }
void sort3(output float a, b, c) { order(a, b); order(b, c); order(a, b); }
void unit(output vector v) { v = normalize(v); }
float median(vector v)
{
    float k[3];
    split3(v, k[0], k[1], k[2]);
    sort3(k[0], k[1], k[2]);
    return k[1];
}
surface deep_inline()
{
    normal n = N;
    unit(n);
    float i, sum = 0;
    for (i = 1; i <= 3; i += 1)
        sum += median(n * i) + median(vector P);
    Ci = sum;
    Oi = 1;
}
