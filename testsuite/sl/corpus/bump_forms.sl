// SPDX-License-Identifier: Apache-2.0
/* bump() of 3.1 in its three forms and displacement by a texture, in one displacement shader. */
displacement bump_forms(string map = ""; float Km = .02)
{
    normal n1 = bump(map, normalize(N), dPdu, dPdv);
    point n2 = bump(map, normalize(N), dPdu, dPdv, s * 2, t * 2);
    normal n3 = bump(map[0], normalize(N), dPdu, dPdv, s, t, s + du, t, s, t + dv, s + du, t + dv);
    float h = Km * (float texture(map, s, t)) + Km * .5 * sin(20 * s) * sin(20 * t);
    P += h * normalize(N);
    N = calculatenormal(P) + 0 * (n1 + normal n2 + n3);
}
