// SPDX-License-Identifier: Apache-2.0
// Panes of coloured glass in a net of lead, on the parameters of a surface: what is opaque, and in which colors light passes,
// changes from place to place, so shadows need this shader ("casts_shadows" "shader").
surface stained(float columns = 12, rows = 7, lead = .09; color hue = color(1, 1, 1); float seed = 3;)
{
    float row = floor(t * rows);
    float shift = .5 * mod(row, 2);
    float x = s * columns + shift, y = t * rows;
    float a = mod(x, 1), b = mod(y, 1);
    float edge = min(min(a, 1 - a), min(b, 1 - b));
    float pane = smoothstep(lead, lead * 1.4, edge);
    float pick = float cellnoise(mod(floor(x), columns) + seed, row + seed);
    color tint = ctransform("hsv", color(pick, .75, 1)) * hue;
    normal Nf = faceforward(normalize(N), I);
    // Lead hides; glass keeps what is not of its color.
    Oi = mix(color(1, 1, 1), (color(1, 1, 1) - tint) * .95, pane);
    color metal = .25 * (ambient() + diffuse(Nf) + 2 * specular(Nf, -normalize(I), .2));
    color glow = .12 * tint * (ambient() + diffuse(Nf) + diffuse(-Nf));
    Ci = Oi * mix(metal, glow, pane);
}
