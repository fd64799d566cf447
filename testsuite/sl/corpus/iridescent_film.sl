// SPDX-License-Identifier: Apache-2.0
/* Thin film interference by wavelength, a loop over the components; soap that is clear in the middle. */
surface iridescent_film(float thickness = 400, index = 1.33, Ks = .6, roughness = .05, strength = 1)
{
    normal Nf = faceforward(normalize(N), I);
    vector IN = normalize(I);
    float cosi = abs(Nf . IN);
    float cost = sqrt(max(0, 1 - (1 - cosi * cosi) / (index * index)));
    float wave[3] = {650, 550, 450};
    float d = thickness * (.8 + .4 * noise(transform("shader", P) * 3));
    color film = 0;
    uniform float i;
    for (i = 0; i < 3; i += 1)
        setcomp(film, i, .5 - .5 * cos(4 * PI * index * d * cost / wave[i]));
    float kr, kt;
    fresnel(IN, Nf, 1 / index, kr, kt);
    float edge = mix(.15, 1, pow(1 - cosi, 2));
    Oi = Os * edge * strength;
    Ci = Oi * film * (.4 + diffuse(Nf)) + Ks * specular(Nf, -IN, roughness);
}
