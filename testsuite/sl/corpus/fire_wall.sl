// SPDX-License-Identifier: Apache-2.0
/* Flames: turbulence shifted by time, a blackbody-like spline, additive: Oi stays 0. */
surface fire_wall(float distortion = .8, chaosscale = 3, chaosoffset = 0, octaves = 6, flameheight = 1, flameamplitude = .8)
{
    point PP = point (s, t, chaosoffset + time) * chaosscale;
    float chaos = 0, i, freq = 1;
    for (i = 0; i < octaves; i += 1) {
        chaos += (1 / freq) * abs(noise(freq * point (xcomp(PP), ycomp(PP) * .5, zcomp(PP) + i)) - .5) * 2;
        freq = freq * 2.17;
    }
    float cmap = .85 * chaos + .8 * (flameamplitude - flameheight * (1 - t)) - .3;
    cmap = clamp(cmap, 0, 1);
    color Cf = spline(cmap, color (0, 0, 0), color (0, 0, 0), color (27, 0, 0) / 255, color (54, 0, 0) / 255, color (162, 0, 0) / 255,
                      color (255, 85, 0) / 255, color (255, 232, 20) / 255, color (255, 255, 255) / 255, color (255, 255, 255) / 255);
    Ci = Cf;
    Oi = 0;
}
