// SPDX-License-Identifier: Apache-2.0
// Polished metal: what lies around comes back, tinted; highlights of lights as in shinymetal.
surface mirror(float Ka = .2, Kd = 0, Ks = .4, Kr = .8, roughness = .03;)
{
    normal Nf = faceforward(normalize(N), I);
    vector V = -normalize(I);
    vector R = reflect(normalize(I), Nf);
    color around = trace(P, R);
    Oi = Os;
    Ci = Os * Cs * (Ka * ambient() + Kd * diffuse(Nf) + Ks * specular(Nf, V, roughness) + Kr * around);
}
