// SPDX-License-Identifier: Apache-2.0
/* Atmosphere that uses depth(), spline and noise of the far point; old untyped style. */
volume noisy_mist (float mindist = 0, maxdist = 1; color background = color "hsv" (.6, .2, .9); float amp = .3;)
{
    float d;
    d = (depth(P) - mindist) / (maxdist - mindist);
    d += amp*(noise(transform("world",P))-.5);
    d = clamp(d,0,1);
    d = spline(d, 0,0,.2,.7,1,1);
    Ci = mix(Ci, background, d);
    Oi = mix (Oi, color (1,1,1), d);
}
