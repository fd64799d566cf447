// SPDX-License-Identifier: Apache-2.0
// 0/0 where u < .5; the light of bad_light is no number and does not come.
surface bad_surface()
{
    float a = step(.5, u);
    normal Nf = faceforward(normalize(N), I);
    Oi = 1;
    a = a / step(.5, u);
    Ci = a * ambient() + diffuse(Nf);
}
