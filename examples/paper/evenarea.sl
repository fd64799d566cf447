// SPDX-License-Identifier: Apache-2.0
// A surface of even radiance, as a light: Cl is what the whole of it would give from P.
light evenarea(float intensity = 1; color lightcolor = 1;)
{
    illuminate (P, N, PI / 2)
        Cl = intensity * lightcolor * (normalize(L).normalize(N)) / (L.L);
}
