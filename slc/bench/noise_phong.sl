// SPDX-License-Identifier: Apache-2.0
/* Benchmark: eight octaves of noise in the colour, and a Phong highlight from a fixed direction. The same computation is
 * written by hand in noise_phong_lanes.c and noise_phong_scalar.c. */
surface noise_phong(float Ka = 0.1, Kd = 0.6, Ks = 0.3, size = 20;) {
    float sum = 0, amplitude = 0.5, frequency = 1, i;
    for (i = 0; i < 8; i += 1) {
        sum += amplitude * noise(frequency * P);
        amplitude *= 0.5;
        frequency *= 2;
    }
    vector Lhat = normalize(vector (1, 2, -3));
    normal Nf = faceforward(normalize(N), I, N);
    vector V = -normalize(I);
    vector R = reflect(-V, Nf);
    float lambert = max(0, Lhat . Nf);
    float highlight = pow(max(0, R . Lhat), size);
    Oi = Os;
    Ci = Os * (Cs * sum * (Ka + Kd * lambert) + Ks * highlight);
}
