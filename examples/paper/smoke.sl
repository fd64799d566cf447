// SPDX-License-Identifier: Apache-2.0
// Smoke between the eye and the surface, lit by the lights inside it: one step at a time, light that arrives there is scattered
// evenly in all directions (single scattering). `density` is what a unit of length takes away.
volume smoke(float density = .06, steps = 32; color albedo = color(.9, .9, .9); float curls = 0, size = 1;)
{
    float length_all = length(I);
    vector along = I / length_all;
    point eye = P - I;
    float step_length = length_all / steps;
    float begin = random();
    color light = 0;
    float transmitted = 1, i;
    for (i = 0; i < steps; i += 1) {
        point X = eye + (i + begin) * step_length * along;
        float here = density;
        if (curls > 0) {
            point W = transform("world", X) / size;
            here *= max(1 + curls * (noise(W) + .5 * noise(2.1 * W) + .25 * noise(4.3 * W) - .875) * 2, 0);
        }
        float kept = exp(-here * step_length);
        color arriving = 0;
        illuminance (X, vector (0, 0, 1), PI) {
            arriving += Cl;
        }
        // Cl is in units where a white matte surface returns Cl cos: a particle sends 1/4 of it into each direction.
        light += transmitted * (1 - kept) * albedo * .25 * arriving;
        transmitted *= kept;
    }
    Ci = Ci * transmitted + light;
    Oi = 1 - (1 - Oi) * transmitted;
}
