// SPDX-License-Identifier: Apache-2.0
/* Fog that thins with height: the integral along the ray in closed form; the world up by name. */
volume ground_fog(float density = .3, falloff = .8, ground = -1; color fogcolor = color (.7, .75, .8); string space = "world"; vector up = vector "world" (0, 1, 0))
{
    point a = transform(space, P - I), b = transform(space, P);
    vector upw = vtransform(space, up);
    float ha = (a - point 0) . upw - ground, hb = (b - point 0) . upw - ground;
    float len = length(I), slope = hb - ha;
    float mean = abs(slope) < 1e-4 ? exp(-falloff * ha) : (exp(-falloff * ha) - exp(-falloff * hb)) / (falloff * slope);
    float thick = 1 - exp(-density * max(mean, 0) * len);
    Ci = mix(Ci, fogcolor, thick);
    Oi = mix(Oi, color 1, thick);
}
