/* SPDX-License-Identifier: Apache-2.0
 * A perfect mirror that shows Kr of what it sees; no differences are lost on the way. */
surface mirror(float Kr = 1, emits = 0)
{
    normal Nf = faceforward(normalize(N), I);
    Oi = Os;
    Ci = Os * (emits + Kr * color trace(P, reflect(normalize(I), Nf)));
}
