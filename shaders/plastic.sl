// SPDX-License-Identifier: Apache-2.0
// plastic: a diffuse body in the colour of the object under a highlight of a colour of its own.
// Parameters: Ka, Kd, Ks     parts of ambient, diffuse and highlight reflection, 0..1
//             roughness      width of the highlight: its cosine exponent is 1/roughness
//             specularcolor  colour of the highlight.
// Source: RI 3.2, Standard RenderMan Interface Shaders, Plastic Surface.
surface plastic(float Ka = 1; float Kd = .5; float Ks = .5; float roughness = .1; color specularcolor = 1;)
{
    normal Nf = faceforward(normalize(N), I);
    vector V = -normalize(I);

    Oi = Os;
    Ci = Os * (Cs * (Ka * ambient() + Kd * diffuse(Nf)) + specularcolor * Ks * specular(Nf, V, roughness));
}
