// SPDX-License-Identifier: Apache-2.0
// Writes dPdu (which 0), dPdv (1), Du(P) (2), Dv(P) (3) or calculatenormal(P) (4), camera space.
surface show_tangents(float which = 0;)
{
    vector v = 0;
    if (which == 0)
        v = dPdu;
    else if (which == 1)
        v = dPdv;
    else if (which == 2)
        v = Du(P);
    else if (which == 3)
        v = Dv(P);
    else
        v = normalize(calculatenormal(P));
    Oi = 1;
    Ci = color(xcomp(v), ycomp(v), zcomp(v));
}
