/* SPDX-License-Identifier: Apache-2.0
 * Benchmark: smoke in a slab, marched along the ray in steps that end where it has become opaque. */
float density_at(point p; uniform float octaves)
{
    float sum = 0, amplitude = .5;
    point q = p;
    uniform float i;
    for (i = 0; i < octaves; i += 1) {
        sum += amplitude * noise(q);
        q *= 2;
        amplitude *= .5;
    }
    return smoothstep(.35, .65, sum);
}

volume smoke(float density = 1.2, scale = .7, stepsize = .25, nearest = 1, farthest = 6, octaves = 3;
             color albedo = color(.8, .82, .85); float shadowed = .6;)
{
    vector D = normalize(I);
    uniform vector to_light = normalize(vector(1, 2, -3));
    float last = min(length(I), farthest), d = nearest + stepsize * random();
    color light = 0, through = 1;
    while (d < last && comp(through, 1) > .02) {
        point Q = scale * transform("shader", E + d * D);
        float here = density_at(Q, octaves);
        if (here > .001) {
            float towards = density_at(Q + .4 * to_light, 2);
            color tau = density * here * stepsize * (color(1, 1, 1) + .2 * (color(1, 1, 1) - albedo));
            color passed = color(exp(-comp(tau, 0)), exp(-comp(tau, 1)), exp(-comp(tau, 2)));
            light += through * (color(1, 1, 1) - passed) * albedo * (1 - shadowed * towards);
            through *= passed;
        }
        d += stepsize;
    }
    Ci = light + through * Ci;
    Oi = (color(1, 1, 1) - through) + through * Oi;
}
