// SPDX-License-Identifier: Apache-2.0
// Output parameters of every type a display can show, with values that follow from u and v. Colour and float are
// multiplied by opacity, as Ci is.
surface show_outputs(output varying color Cdiffuse = 0; output varying float fall = 0; output varying normal Nout = 0;
                     output varying point Pout = 0; output uniform float id = 0; output varying color pair[2] = {0, 0};
                     output varying matrix M = 1; float number = 7;)
{
    Oi = Os;
    Ci = Oi * Cs;
    Cdiffuse = Oi * color(u, v, u * v);
    fall = comp(Oi, 0) * u * u;
    Nout = N;
    Pout = P;
    id = number;
    pair[0] = Oi * color(u, 0, 0);
    pair[1] = Oi * color(0, v, 1);
    M = matrix (u, 0, 0, 0, 0, v, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1);
}
