// SPDX-License-Identifier: Apache-2.0
// Shows what an imager sees: P, u, v and alpha, by `pick`; prints one line per picture.
imager tint_imager(float pick = 0;)
{
    if (pick == 0) {
        Ci = color(.25, comp(Ci, 1), 0);
        Oi = color(1, 1, 1);
        alpha = .5;
    } else if (pick == 1) {
        Ci = color(xcomp(P), ycomp(P), zcomp(P));
    } else if (pick == 2) {
        Ci = color(ncomps, time, dtime);
    } else {
        Ci = Ci / 0;
    }
    if (xcomp(P) == .5 && ycomp(P) == .5)
        printf("imager at %p\n", P);
}
