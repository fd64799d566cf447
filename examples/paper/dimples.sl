// SPDX-License-Identifier: Apache-2.0
// Rows of round dents on the parameters of a surface; `depth` in shader space.
displacement dimples(float columns = 24, rows = 10, depth = .03, radius = .42;)
{
    float row = floor(t * rows);
    float shift = .5 * mod(row, 2);
    float a = mod(s * columns + shift, 1) - .5, b = mod(t * rows, 1) - .5;
    float r = sqrt(a * a + b * b) / radius;
    float dent = (r < 1) ? (1 - r * r) * (1 - r * r) : 0;
    P -= depth * dent * normalize(N);
    N = calculatenormal(P);
}
