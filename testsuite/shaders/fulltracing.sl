/* SPDX-License-Identifier: Apache-2.0
 * A mirror that shows what fulltrace() tells: distance, level of the deepest miss, z of its direction in camera space. */
surface fulltracing()
{
    color seen = 0;
    float far = 0;
    point Phit = 0, Pmiss = 0;
    vector Nhit = 0, Rmiss = 0;
    normal Nf = faceforward(normalize(N), I);
    float level = fulltrace(P, reflect(normalize(I), Nf), seen, far, Phit, Nhit, Pmiss, Rmiss);
    Oi = 1;
    Ci = color(far, level, zcomp(Rmiss));
}
