// SPDX-License-Identifier: Apache-2.0
/* Wavy glass: the normal is bent by noise before refract(); falls back to transparency where rays do nothing. */
surface bathroom_glass(float Ka = .1, Kd = .2, Ks = 1, freq = 10, amp = .1, eta = 1.3, roughness = .02)
{
    point Q = transform("object", P) * freq;
    normal Nn = normalize(N);
    point Pb = P + Nn * amp / freq * (noise(Q) + .5 * noise(2 * Q));
    normal Nb = normalize(calculatenormal(Pb));
    normal Nf = faceforward(Nb, I);
    vector T = refract(normalize(I), Nf, I . N < 0 ? 1 / eta : eta);
    color behind = (T . T > 0) ? trace(P, T) : color trace(P, reflect(normalize(I), Nf));
    float facing = abs(Nf . normalize(I));
    Oi = mix(1, .3, facing) * Os;
    Ci = Oi * (Cs * (Ka * ambient() + Kd * diffuse(Nf)) + Ks * specular(Nf, -normalize(I), roughness)) + .7 * behind;
}
