// SPDX-License-Identifier: Apache-2.0
// Rings around the middle of a surface, dying out, with uneven water between them.
displacement ripples(float frequency = 26, height = .012, noisy = .3;)
{
    float x = s - .42, y = t - .55;
    float r = sqrt(x * x + y * y);
    float wave = sin(frequency * 6.2832 * r) * exp(-5 * r) + noisy * (noise(14 * s, 14 * t) - .5);
    P += height * wave * normalize(N);
    N = calculatenormal(P);
}
