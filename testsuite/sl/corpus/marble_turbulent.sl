// SPDX-License-Identifier: Apache-2.0
// Turbulence with a loop that stops at the footprint, and a colour spline over repeated knots.
surface marble_turbulent(float Ka = .5, Kd = .4, Ks = .2, roughness = .1, txtscale = 1, veins = 6;
                         color specularcolor = 1; string shadingspace = "shader";)
{
    point PP = txtscale * transform(shadingspace, P);
    float width = max(sqrt(area(PP)), 1e-7);
    float cutoff = clamp(0.5 / width, 0, 32);
    float f, turb = 0;
    for (f = 1; f < 0.5 * cutoff; f *= 2)
        turb += abs(2 * noise(PP * f) - 1) / f;
    float fade = clamp(2 * (cutoff - f) / cutoff, 0, 1);
    turb += fade * abs(2 * noise(PP * f) - 1) / f;
    float csp = clamp(4 * turb - 3, 0, 1);
    color Ct = color spline(csp, color (0.25, 0.25, 0.35), color (0.25, 0.25, 0.35), color (0.2, 0.2, 0.3),
                            color (0.2, 0.2, 0.3), color (0.9, 0.9, 0.92), color (0.9, 0.9, 0.92));
    normal Nf = faceforward(normalize(N), I);
    vector V = -normalize(I);
    Oi = Os;
    Ci = Os * (Ct * (Ka * ambient() + Kd * diffuse(Nf)) + specularcolor * Ks * specular(Nf, V, roughness));
}
