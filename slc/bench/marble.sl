/* SPDX-License-Identifier: Apache-2.0
 * Benchmark: veined marble. Eight octaves of folded noise choose a colour from a spline. */
surface marble(float scale = 1, contrast = 1.6; float Ka = .2, Kd = .8; float polish = .3, size = 24;)
{
    point Q = scale * transform("shader", P);
    float vein = 0, amplitude = 1, frequency = 1;
    uniform float octave;
    for (octave = 0; octave < 8; octave += 1) {
        vein += amplitude * abs(.5 - noise(frequency * Q));
        amplitude *= .5;
        frequency *= 2;
    }
    color stone = spline(clamp(contrast * vein, 0, 1),
        color(.93, .91, .88), color(.93, .91, .88), color(.86, .85, .84), color(.74, .75, .78),
        color(.52, .55, .62), color(.31, .34, .42), color(.20, .22, .30), color(.12, .12, .18),
        color(.08, .08, .12), color(.05, .05, .08), color(.05, .05, .08));
    normal Nf = faceforward(normalize(N), I);
    uniform vector to_light = normalize(vector(1, 2, -3));
    vector mirror = reflect(normalize(I), Nf);
    Oi = Os;
    Ci = Os * (Cs * stone * (Ka + Kd * max(0, Nf . to_light)) + polish * pow(max(0, mirror . to_light), size));
}
