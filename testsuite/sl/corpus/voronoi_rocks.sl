// SPDX-License-Identifier: Apache-2.0
/* Cells by their two nearest feature points: three nested loops, output formals, colour by cell. */
void two_nearest(point Q; float jitter; output float f1; output point pos1; output float f2; output point pos2)
{
    point thiscell = point (floor(xcomp(Q)) + .5, floor(ycomp(Q)) + .5, floor(zcomp(Q)) + .5);
    f1 = f2 = 1000;
    uniform float i, j, k;
    for (i = -1; i <= 1; i += 1) {
        for (j = -1; j <= 1; j += 1) {
            for (k = -1; k <= 1; k += 1) {
                point testcell = thiscell + vector (i, j, k);
                point pos = testcell + jitter * (vector cellnoise(testcell) - .5);
                vector offset = pos - Q;
                float dist = offset . offset;
                if (dist < f1) {
                    f2 = f1; pos2 = pos1;
                    f1 = dist; pos1 = pos;
                } else if (dist < f2) {
                    f2 = dist; pos2 = pos;
                }
            }
        }
    }
    f1 = sqrt(f1);
    f2 = sqrt(f2);
}
surface voronoi_rocks(float freq = 4, jitter = .9, mortar = .08, Ka = 1, Kd = .8; color mortarcolor = color (.3, .28, .25))
{
    point Q = transform("object", P) * freq;
    float f1, f2;
    point p1, p2;
    two_nearest(Q, jitter, f1, p1, f2, p2);
    float scale = (distance(p1, p2)) / (distance(p1, Q) + distance(p2, Q));
    float edge = smoothstep(mortar, mortar * 1.6, (f2 - f1) / max(scale, .001));
    color rock = Cs * (.6 + .6 * cellnoise(p1)) * mix(color (1, .9, .8), color (.8, .9, 1), cellnoise(p1 + 20));
    normal Nf = faceforward(normalize(N), I);
    Oi = Os;
    Ci = Oi * mix(mortarcolor, rock, edge) * (Ka * ambient() + Kd * diffuse(Nf));
}
