// SPDX-License-Identifier: Apache-2.0
// paintedplastic: plastic whose body colour is multiplied by a texture.
// Parameters: Ka, Kd, Ks, roughness, specularcolor  as in plastic
//             texturename  colour texture over s, t; "" paints white.
// Source: RI 3.2, Standard RenderMan Interface Shaders, Painted Plastic Surface.
surface paintedplastic(float Ka = 1; float Kd = .5; float Ks = .5; float roughness = .1; color specularcolor = 1;
                       string texturename = "";)
{
    normal Nf = faceforward(normalize(N), I);
    vector V = -normalize(I);
    color paint = Cs;

    if (texturename != "")
        paint *= color texture(texturename);
    Oi = Os;
    Ci = Os * (paint * (Ka * ambient() + Kd * diffuse(Nf)) + specularcolor * Ks * specular(Nf, V, roughness));
}
