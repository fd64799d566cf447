// SPDX-License-Identifier: Apache-2.0
// arealight: light from the surfaces of an AreaLightSource, from the side their normals point to, as bright by a Lambertian
// cosine. The light is the mean over its surface: from far off, and straight in front, it is a point light of this intensity.
// Parameters: intensity   Cl at distance 1 (units of current space) straight ahead, factor on lightcolor
//             lightcolor  colour of the light.
// Source: RI 3.2, Area light sources.
light arealight(float intensity = 1; color lightcolor = 1;)
{
    illuminate(P, N, PI / 2)
        Cl = intensity * lightcolor * (normalize(L) . normalize(N)) / (L . L);
}
