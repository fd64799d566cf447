// SPDX-License-Identifier: Apache-2.0
// warns: variable 'j' is assigned a varying value
// warns: variable 'i' is assigned a varying value
// Loops: break and continue with counts, per point exits, nested conditions.
surface loops(uniform float maximum = 8; float threshold = .5)
{
    uniform float i, j;
    float sum = 0, hits = 0;
    for (i = 0; i < maximum; i += 1) {
        for (j = 0; j < maximum; j += 1) {
            float n = noise(s * i, t * j);
            if (n < .1) continue;
            if (n > .9) break 2;
            if (n > .8) continue 2;
            sum += n;
        }
        hits += 1;
        if (sum > threshold) break;
    }
    while (sum > 1) {
        sum /= 2;
        if (hits < 0) { hits = 0; break; }
    }
    for (;;) { if (hits > 10) break; hits += 3; }
    Ci = Cs * sum / max(hits, 1);
    Oi = Os;
}
