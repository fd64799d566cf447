// SPDX-License-Identifier: Apache-2.0
// Stained glass whose opacity the shader computes: by Cs, more at the rim.
surface glass(float stain = .5;)
{
    float rim = 1 - abs(normalize(N) . normalize(I));
    Oi = mix(1 - Cs, color(1, 1, 1), stain * rim);
    Ci = Oi * Cs * (ambient() + diffuse(faceforward(normalize(N), I)));
}
