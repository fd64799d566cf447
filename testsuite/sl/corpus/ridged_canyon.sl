// SPDX-License-Identifier: Apache-2.0
/* Ridged fractal with feedback: each octave is weighted by the one before. */
float ridged(point Q; uniform float octaves, lacunarity, H, offset, gain)
{
    uniform float i, freq = 1;
    float signal = offset - abs(2 * noise(Q) - 1);
    signal *= signal;
    float result = signal, weight = 1;
    point q = Q;
    for (i = 1; i < octaves; i += 1) {
        freq *= lacunarity;
        q = q * lacunarity;
        weight = clamp(signal * gain, 0, 1);
        signal = offset - abs(2 * noise(q) - 1);
        signal *= signal * weight;
        result += signal * pow(freq, -H);
    }
    return result;
}
displacement ridged_canyon(float Km = .1, octaves = 5, lacunarity = 2, H = .9, offset = 1, gain = 2, freq = 1.5)
{
    float h = ridged(transform("shader", P) * freq, octaves, lacunarity, H, offset, gain);
    P += Km * h * normalize(N);
    N = calculatenormal(P);
}
