// SPDX-License-Identifier: Apache-2.0
// matte: an ideal diffuse (Lambert) reflector.
// Parameters: Ka, Kd  parts of ambient and direct light reflected, 0..1.
// Source: RI 3.2, Standard RenderMan Interface Shaders, Matte Surface.
surface matte(float Ka = 1; float Kd = 1;)
{
    normal Nf = faceforward(normalize(N), I);

    Oi = Os;
    Ci = Os * Cs * (Ka * ambient() + Kd * diffuse(Nf));
}
