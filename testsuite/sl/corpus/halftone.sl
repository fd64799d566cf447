// SPDX-License-Identifier: Apache-2.0
/* Newspaper dots: an imager turns the picture into dots of ink on paper. */
imager halftone(float size = 6, angle = .5; color ink = 0, paper = 1;)
{
    float x = xcomp(P), y = ycomp(P);
    float rx = (x * cos(angle) - y * sin(angle)) / size, ry = (x * sin(angle) + y * cos(angle)) / size;
    float dx = mod(rx, 1) - .5, dy = mod(ry, 1) - .5;
    color full = Ci + (1 - alpha) * paper;
    float lum = clamp(.3 * comp(full, 0) + .59 * comp(full, 1) + .11 * comp(full, 2), 0, 1);
    float radius = sqrt((1 - lum) / 2);
    float dot1 = 1 - smoothstep(radius - .15, radius + .15, sqrt(dx * dx + dy * dy) * 1.2);
    Ci = mix(paper, ink, dot1);
    Oi = 1;
    alpha = 1;
}
