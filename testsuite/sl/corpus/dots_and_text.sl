// SPDX-License-Identifier: Apache-2.0
/* Parameters parsed from text: match(), format(), concat(), string arrays, comparisons; names of textures built. */
surface dots_and_text(string pattern = "dots:fine", prefix = "map", frames[3] = {"a", "b", "c"}; uniform float frame = 7;)
{
    uniform string name = concat(prefix, ".", format("%04d", frame), ".tx");
    uniform float fine = match("fine$", pattern), dots = match("^dots", pattern), numbers = match("[0-9][0-9]*", pattern);
    uniform float freq = fine == 1 ? 12 : 4;
    uniform float i, found = -1;
    for (i = 0; i < 3; i += 1) {
        if (frames[i] == "b")
            found = i;
    }
    float x = mod(s * freq, 1) - .5, y = mod(t * freq, 1) - .5;
    float mark = 0;
    if (dots == 1)
        mark = 1 - smoothstep(.25, .3, sqrt(x * x + y * y));
    else if (pattern == "checks" || numbers == 1)
        mark = (x > 0) == (y > 0) ? 1 : 0;
    color Ct = mix(Cs, color "hsv" (found / 3, .8, .8), mark);
    if (name == "map.0007.tx" && shadername() != "")
        Ct *= color (1, 1, .9);
    Ci = Os * Ct * (ambient() + diffuse(normalize(faceforward(N, I))));
    Oi = Os;
}
