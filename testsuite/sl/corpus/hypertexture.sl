// SPDX-License-Identifier: Apache-2.0
// warns: variable 'i' is assigned a varying value
/* Marches through a closed primitive; compares colours with numbers. */
surface hypertexture(float radius = 1, density = 4; uniform float stepsize = .1, max_steps = 64;)
{
    color dens_color(point p)
    {
        extern float radius, density;
        float d = 1 - smoothstep(.5 * radius, radius, length(vector p));
        return density * d * (.5 + .5 * color noise(4 * p));
    }
    if (I.N > 0) {
        Ci = Oi = 0;
    } else {
        point p = transform("object", P);
        vector dir = normalize(vtransform("object", I)) * stepsize;
        uniform float i = 0;
        Ci = Oi = 0;
        while (Oi < 0.999 && i < max_steps) {
            color o = dens_color(p) * stepsize;
            Ci += (1 - Oi) * o * Cs;
            Oi += (1 - Oi) * o;
            p += dir;
            i += 1;
        }
    }
}
