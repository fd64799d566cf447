// SPDX-License-Identifier: Apache-2.0
/* Cool to warm shading by the signed angle to the light; blends object colour into both ends. */
surface gooch(color cool = color (0, 0, .55), warm = color (.4, .4, 0); float alpha = .3, beta = .5; float Ks = .6, roughness = .08)
{
    normal Nf = normalize(faceforward(N, I));
    vector V = normalize(-I);
    color kcool = cool + alpha * Cs, kwarm = warm + beta * Cs;
    color total = 0; float count = 0;
    illuminance ("", P, Nf, PI) {
        float t2 = (1 + (normalize(L) . Nf)) / 2;
        total += mix(kcool, kwarm, t2);
        count += 1;
    }
    if (count > 0) total /= count;
    Ci = Os * (total + Ks * specular(Nf, V, roughness));
    Oi = Os;
}
