// SPDX-License-Identifier: Apache-2.0
// warns: formal 'P' is not 'output'
// Formals and locals called like predefined variables; built-ins still read the global ones.
float at(point P; float s, t) { P += 1; return noise(P) * s + t; }
surface predefined_shadowed(float u_scale = 1; color Cs = (1, 0, 0))
{
    float s2 = s, alpha = .5, time = 2;
    {
        float s = s2 * u_scale, t = 0;
        normal N = normal (0, 0, 1);
        vector I = vector (0, 0, -1);
        Ci = Cs * at(P, s, t) * diffuse(faceforward(N, I));
    }
    Ci += texture("") * alpha * time * t;
    Oi = 1;
}
