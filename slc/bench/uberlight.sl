/* SPDX-License-Identifier: Apache-2.0
 * Benchmark: a light with many controls [Barzel97]: a rounded rectangle for a beam, cuts near and far, falloff
 * by distance and angle, a noisy slide. */
float rounded(float x, y, wide_in, high_in, wide_out, high_out, roundness)
{
    float inside = 0, ax = abs(x), ay = abs(y);
    if (roundness < 1e-4) {
        inside = (1 - smoothstep(wide_in, wide_out, ax)) * (1 - smoothstep(high_in, high_out, ay));
    } else {
        float e = 2 / roundness, minus = -.5 * roundness;
        float q = wide_in * high_in * pow(pow(max(high_in * ax, 1e-6), e) + pow(max(wide_in * ay, 1e-6), e), minus);
        float r = wide_out * high_out * pow(pow(max(high_out * ax, 1e-6), e) + pow(max(wide_out * ay, 1e-6), e), minus);
        inside = 1 - smoothstep(q, r, 1);
    }
    return inside;
}

light uberlight(string shape = "spot"; float intensity = 1; color lightcolor = 1;
                float near_from = .1, near_to = .5, far_from = 20, far_to = 40;
                float falloff = 2, reference = 10, most = 4;
                float wide = .4, high = .3, edge = .1, roundness = .5, beam = 1;
                float slide = .5, slide_scale = 4; point slide_offset = point "shader" (0, 0, 0);
                float blocker = 0; point blocker_at = point "shader" (0, 0, 2); float blocker_radius = .3;)
{
    point S = transform("shader", Ps);
    float x = xcomp(S), y = ycomp(S), z = zcomp(S);
    float distance = length(vector(S));
    illuminate(point "shader" (0, 0, 0)) {
        float power = smoothstep(near_from, near_to, z) * (1 - smoothstep(far_from, far_to, z));
        if (shape != "omni" && z > 0) {
            power *= rounded(x / z, y / z, wide, high, wide + edge, high + edge, roundness);
        } else if (shape != "omni") {
            power = 0;
        }
        if (falloff != 0) {
            power *= distance > reference ? pow(reference / distance, falloff)
                                          : min(most, pow(reference / max(distance, .001), falloff));
        }
        if (beam > 0) {
            power *= pow(max(0, z / max(distance, .001)), beam);
        }
        if (slide > 0 && power > 0) {
            power *= 1 - slide * noise(slide_scale * (S - slide_offset));
        }
        if (blocker > 0) {
            float off = ptlined(point "shader" (0, 0, 0), Ps, blocker_at);
            power *= 1 - blocker * (1 - smoothstep(.8 * blocker_radius, blocker_radius, off));
        }
        Cl = intensity * power * lightcolor;
    }
}
