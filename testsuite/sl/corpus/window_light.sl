// SPDX-License-Identifier: Apache-2.0
/* Sun through a window with panes: the plane of the window is hit by the line to the light. Solar with a cast axis. */
float pane(float x, lo, hi, count, bar, fuzz)
{
    float k = (x - lo) / (hi - lo) * count;
    float inside = smoothstep(0, fuzz, k) - smoothstep(count - fuzz, count, k);
    float f = mod(k, 1);
    return inside * (smoothstep(bar / 2, bar / 2 + fuzz, f) - smoothstep(1 - bar / 2 - fuzz, 1 - bar / 2, f));
}
light window_light(float intensity = 1; color lightcolor = color (1, .9, .7), darkcolor = color (.05, .05, .1);
                   point center = point "world" (0, 0, 0); vector in = vector "world" (0, 0, 1), up = vector "world" (0, 1, 0);
                   float width = 2, height = 2, xorder = 2, yorder = 3, bar = .1, fuzz = .05;)
{
    vector path = normalize(in);
    vector right = normalize(up ^ path), vup = path ^ right;
    solar (path, 0) {
        float offset = (Ps - center) . path;
        vector Pint = (Ps - center) - offset * path;
        float w = pane(Pint . right, -width / 2, width / 2, xorder, bar, fuzz)
            * pane(Pint . vup, -height / 2, height / 2, yorder, bar, fuzz);
        Cl = intensity * mix(darkcolor, lightcolor, w);
    }
}
