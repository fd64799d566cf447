// SPDX-License-Identifier: Apache-2.0
// Gives light of its own, and returns the share Kd of what comes.
surface glow(float Kd = .5; color emission = .25;)
{
    Oi = Os;
    Ci = Os * (emission + Kd * Cs * (ambient() + diffuse(faceforward(normalize(N), I))));
}
