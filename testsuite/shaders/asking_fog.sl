// SPDX-License-Identifier: Apache-2.0
// A volume that changes nothing unless the surface and displacement shaders tell it something unexpected: tone is 99
// after the surface has run, height is slope * u.
volume asking_fog(float density = .5; float slope = 1;)
{
    float tone = -1, height = -1, other = -3;
    if (surface("tone", tone) == 0 || tone != 99)
        printf("wrong tone in the volume: %f\n", tone);
    if (displacement("height", height) == 0 || height < 0 || height > slope)
        printf("wrong height in the volume: %f\n", height);
    if (surface("nothing", other) != 0 || other != -3)
        printf("wrong message in the volume\n");
    if (length(I) <= 0 || length(P - I) > 3)
        printf("wrong ray in the volume\n");
}
