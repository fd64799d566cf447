// SPDX-License-Identifier: Apache-2.0
/* Light as if through moving water: layers of noise sharpened to bright lines, in the light's space. */
light caustic_fake(float intensity = 1, freq = 2, sharp = 8, layers = 3, phase = 0; color lightcolor = color (.9, 1, 1);
                   point from = point "shader" (0, 0, 0); point to = point "shader" (0, 0, 1);)
{
    solar (to - from, 0.0) {
        point Q = transform("shader", Ps);
        float i, bright = 0;
        setzcomp(Q, phase);
        for (i = 0; i < layers; i += 1) {
            float n = 1 - abs(2 * noise(Q * freq + i * 7.7, phase) - 1);
            bright += pow(n, sharp) / (i + 1);
            Q *= 1.7;
        }
        Cl = intensity * lightcolor * (.4 + bright);
    }
}
