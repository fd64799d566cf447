// SPDX-License-Identifier: Apache-2.0
// metal: highlights in the colour of the object, no diffuse part.
// Parameters: Ka, Ks     parts of ambient light and of highlights reflected, 0..1
//             roughness  width of the highlight: its cosine exponent is 1/roughness.
// Source: RI 3.2, Standard RenderMan Interface Shaders, Metal Surface.
surface metal(float Ka = 1; float Ks = 1; float roughness = .1;)
{
    normal Nf = faceforward(normalize(N), I);
    vector V = -normalize(I);

    Oi = Os;
    Ci = Os * Cs * (Ka * ambient() + Ks * specular(Nf, V, roughness));
}
