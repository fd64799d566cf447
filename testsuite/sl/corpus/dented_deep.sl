// SPDX-License-Identifier: Apache-2.0
/* Dents: a power of a sum of noises, in object space, moved back by ntransform. */
displacement dented_deep(float Km = .2, power = 3, frequency = 2, maxoctaves = 6)
{
    float size = 1, magnitude = 0, i;
    point P2 = transform("object", P);
    normal N2 = ntransform("object", N);
    for (i = 0; i < maxoctaves; i += 1.0) {
        magnitude += pow(abs(.5 - noise(P2 * frequency * size)) / size, power);
        size *= 2.0;
    }
    P2 += vector N2 * 0 - Km * magnitude * normalize(N2);
    P = transform("object", "current", P2);
    N = calculatenormal(P);
}
