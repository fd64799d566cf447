// SPDX-License-Identifier: Apache-2.0
// A surface of radiosity 1 as an area light: what it gives a point is its configuration factor. `area` is its area.
light lambertlight(float area = 1;)
{
    illuminate(P, N, PI / 2)
        Cl = area * (normalize(L) . normalize(N)) / (PI * (L . L));
}
