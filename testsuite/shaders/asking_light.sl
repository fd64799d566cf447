// SPDX-License-Identifier: Apache-2.0
// Shines along z with what the surface and its displacement shader say: Cl = (tone, height, kind of the surface).
light asking_light(float intensity = 1;)
{
    float tone = -1, height = -1, scale = -1;
    if (surface("tone", tone) == 0)
        tone = -2;
    if (displacement("height", height) == 0)
        height = -2;
    if (surface("scale", scale) == 0)
        scale = -2;
    solar(vector "world" (0, 0, 1), 0)
        Cl = intensity * color(tone, height, scale);
}
