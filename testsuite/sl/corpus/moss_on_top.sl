// SPDX-License-Identifier: Apache-2.0
/* Two materials by slope and noise; nested functions that share a local through extern. */
surface moss_on_top(float amount = .5, freq = 6, Ka = 1, Kd = .9; vector up = vector "world" (0, 1, 0); color moss = color (.2, .4, .1), stone = color (.5, .48, .45))
{
    normal Nn = normalize(N);
    point Q = transform("shader", P) * freq;
    float turb(float start)
    {
        extern point Q;
        float one(float k)
        {
            extern point Q;
            extern float start;
            return abs(2 * noise(Q * k + start) - 1) / k;
        }
        return one(1) + one(2) + one(4) + one(8);
    };
    float slope = Nn . normalize(up) + .6 * (turb(3.3) - .6);
    float k = smoothstep(1 - amount - .15, 1 - amount + .15, slope);
    color Ct = mix(stone * (.6 + .5 * turb(0)), moss * (.5 + turb(7)), k);
    Oi = Os;
    Ci = Os * Ct * (Ka * ambient() + Kd * diffuse(faceforward(Nn, I)));
}
