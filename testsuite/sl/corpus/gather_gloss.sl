// SPDX-License-Identifier: Apache-2.0
/* Blurred reflection with gather, its else branch for the surroundings, continue and break inside. */
surface gather_gloss(float Kr = .5, samples = 8, blur = .2, Kd = .5; color surrounding = color (.3, .4, .6);)
{
    normal Nf = faceforward(normalize(N), I);
    vector R = reflect(normalize(I), Nf);
    color sum = 0, hc = 0;
    float hits = 0, len = 0;
    vector dir = 0;
    gather ("illuminance", P, R, blur, samples, "surface:Ci", hc, "ray:length", len, "ray:direction", dir, "maxdist", 100) {
        if (len < .001)
            continue;
        sum += hc;
        hits += 1;
        if (hits > samples)
            break;
    } else {
        sum += surrounding * (.5 + .5 * ycomp(normalize(dir)));
    }
    Oi = Os;
    Ci = Os * (Cs * Kd * diffuse(Nf) + Kr * sum / samples);
}
