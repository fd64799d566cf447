// SPDX-License-Identifier: Apache-2.0
// Triples take their type from context; sixteen values are a matrix.
void move(output point p; vector by) { p += by; }
normal flip(normal n) { return (-xcomp(n), -ycomp(n), -zcomp(n)); }
surface tuples(vector up = (0, 1, 0); color tint = (.9, .8, .7); matrix m = (1,0,0,0, 0,1,0,0, 0,0,1,0, 1,2,3,1))
{
    point q = (s, t, 0);
    move(q, (1, 0, 0));
    normal Nn = flip(N);
    vector v = s > .5 ? (1, 0, 0) : (0, 1, 0);
    color c = t > .5 ? tint : (0, 0, 1);
    matrix twice = m * 2, all = (s, 0, 0, 0, 0, s, 0, 0, 0, 0, s, 0, t, t, t, 1);
    point moved = transform(all * twice / m, (1, 2, 3));
    float same = (q == (1, 0, 0)) + (m != twice);
    Ci = c * (same + (up + (0, 0, 1)).v) + color Nn + color moved;
    Oi = (1, 1, 1);
}
