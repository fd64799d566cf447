// SPDX-License-Identifier: Apache-2.0
/* Clouds on a sky dome: only opacity and colour, no lights; fractal sum without filtering. */
#define snoise(p) (2 * (float noise(p)) - 1)
surface cloud_plane(float txtscale = 4, omega = .5, lambda = 2, threshold = .1, octaves = 8; color skycolor = color (.15, .15, .6), cloudcolor = 1)
{
    point PP = txtscale * transform("shader", P);
    float value = 0, l = 1, o = 1;
    float i;
    for (i = 0; i < octaves; i += 1) {
        value += o * snoise(PP * l);
        l *= lambda;
        o *= omega;
    }
    value = clamp(value, -1, 1);
    color Ct = mix(skycolor, cloudcolor, smoothstep(threshold, 1, value));
    Oi = 1.0;
    Ci = Ct;
}
