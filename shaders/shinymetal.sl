// SPDX-License-Identifier: Apache-2.0
// shinymetal: metal that also mirrors an environment map.
// Parameters: Ka, Ks, Kr   parts of ambient light, highlights and mirrored environment, 0..1
//             roughness    width of the highlight: its cosine exponent is 1/roughness
//             texturename  environment map, looked up by directions of world space; "" mirrors nothing, "reflection" what is there.
// Source: RI 3.2, Standard RenderMan Interface Shaders, Shiny Metal Surface.
surface shinymetal(float Ka = 1; float Ks = 1; float Kr = 1; float roughness = .1; string texturename = "";)
{
    normal Nf = faceforward(normalize(N), I);
    vector V = -normalize(I);
    color mirrored = 0;

    if (texturename != "") {
        vector D = reflect(I, Nf);
        if (texturename != "reflection")
            D = vtransform("world", D);
        mirrored = Kr * color environment(texturename, D);
    }
    Oi = Os;
    Ci = Os * Cs * (Ka * ambient() + Ks * specular(Nf, V, roughness) + mirrored);
}
