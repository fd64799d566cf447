// SPDX-License-Identifier: Apache-2.0
// Precedence: dot above product above cross above sum; casts bind like a sign.
surface dot_cross(float gain = 2;)
{
    vector a = vector P + vector N, b = 2 * vector noise(P) - 1;
    float k = I.N/(I.I * N.N);
    vector c = gain * a ^ b + dPdu ^ dPdv;
    float m = -I.N;
    float q = (a ^ b).c;
    Ci = Oi = abs(k) + length(c) * 1. - m+q*.5;
}
