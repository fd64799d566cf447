// SPDX-License-Identifier: Apache-2.0
displacement study_waves(float freq = 8, amplitude = .05;)
{
    P += amplitude * sin(2 * PI * freq * s) * sin(2 * PI * freq * t) * normalize(N);
    N = calculatenormal(P);
}
