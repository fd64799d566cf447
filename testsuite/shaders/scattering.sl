/* SPDX-License-Identifier: Apache-2.0
 * A thin volume that scatters light: the sum over steps along the ray of density times the light that arrives there. */
volume scattering(float density = .1, steps = 8)
{
    uniform float i;
    vector step = I / steps;
    point X = P - I + step / 2;
    color sum = 0;
    for (i = 0; i < steps; i += 1) {
        illuminance (X, vector(0, 0, 1), PI)
            sum += Cl;
        X += step;
    }
    Ci += density * length(step) * sum;
}
