// SPDX-License-Identifier: Apache-2.0
// Boards along s with grain.
surface wood(float Ka = 1, Kd = .8, Ks = .08, roughness = .15, boards = 5; color dark = color(.30, .16, .08);)
{
    normal Nf = faceforward(normalize(N), I);
    float board = floor(t * boards);
    float b = mod(t * boards, 1);
    float grain = noise(4 * s + 17 * board, 60 * (b + .1 * noise(9 * s, board)) + 31 * board);
    float gap = smoothstep(0, .03, min(b, 1 - b));
    color c = mix(dark, Cs, .35 + .65 * grain) * mix(.5, 1, gap) * (.85 + .3 * float cellnoise(board));
    Oi = Os;
    Ci = Os * (c * (Ka * ambient() + Kd * diffuse(Nf)) + Ks * specular(Nf, -normalize(I), roughness));
}
