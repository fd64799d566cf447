// SPDX-License-Identifier: Apache-2.0
/* Sum of noises with a uniform loop counter; no filtering, as it used to be. */
surface granite_stone(float Kd = .8, Ka = .2, grainscale = 4)
{
    float sum = 0;
    float i, freq = 1.0;
    point Pshad = transform("shader", P);
    for (i = 0; i < 6; i = i + 1) {
        sum = sum + abs (.5 - noise( 4 * grainscale * freq * Pshad))/freq;
        freq *= 2;
    }
    Ci = Cs * sum * (Ka + Kd * diffuse(faceforward(normalize(N), I)));
    Oi = Os;
    Ci *= Oi;
}
