/* SPDX-License-Identifier: Apache-2.0
 * Benchmark: a plank of a ring-porous wood: rings bent by 3-D noises, grain along the trunk, edges and
 * octaves faded by the sample's width. */
#define WIDTH_OF(x) max(abs(Du(x) * du) + abs(Dv(x) * dv), 1e-6)
#define WIDTH_OF_POINT(p) max(sqrt(area(p)), 1e-6)
#define FADED(x, w) ((2 * noise(x) - 1) * (1 - smoothstep(.2, .6, w)))

float wobble(point p; float w; uniform float octaves)
{
    float sum = 0, amplitude = 1, width = w;
    point q = p;
    uniform float i;
    for (i = 0; i < octaves; i += 1) {
        sum += amplitude * FADED(q, width);
        amplitude *= .5;
        width *= 2;
        q *= 2;
    }
    return sum;
}

surface wood(float rings = 14, tilt = .06, bend = .25, grain = 40, roughness = .15;
             color early = color(.62, .42, .24), late = color(.36, .2, .1);
             float Ka = .2, Kd = .8, Ks = .25;)
{
    point Q = transform("shader", P);
    float w = WIDTH_OF_POINT(Q);
    vector lean = bend * vector(wobble(Q, w, 3), wobble(Q + vector(17, 5, 3), w, 3), 0);
    point R = Q + lean + tilt * vector(zcomp(Q), 0, 0);
    float r = sqrt(xcomp(R) * xcomp(R) + ycomp(R) * ycomp(R)) * rings;
    r += .3 * wobble(point(xcomp(Q), ycomp(Q), .2 * zcomp(Q)) * 2, 2 * w, 2);
    float width = WIDTH_OF(r);
    float phase = mod(r, 1);
    float dark = smoothstep(.2 - width, .85 + width, phase) * (1 - smoothstep(.9 - width, 1, phase));
    point G = point(xcomp(R) * grain, ycomp(R) * grain, zcomp(R) * 2);
    float fibre = wobble(G, grain * w, 3);
    float pores = smoothstep(.55, .8, noise(2 * G)) * (1 - smoothstep(.3, .7, 2 * grain * w)) * (1 - dark);
    color Ct = mix(early, late, clamp(dark + .15 * fibre, 0, 1)) * (1 - .45 * pores);
    normal Nf = faceforward(normalize(N), I);
    uniform vector to_light = normalize(vector(1, 2, -3));
    vector mirror = reflect(normalize(I), Nf);
    Oi = Os;
    Ci = Os * (Cs * Ct * (Ka + Kd * max(0, Nf . to_light)) +
               Ks * (1 - .5 * dark) * pow(max(0, mirror . to_light), 1 / roughness));
}
