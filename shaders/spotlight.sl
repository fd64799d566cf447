// SPDX-License-Identifier: Apache-2.0
// spotlight: a point light that shines within a cone, brightest along its axis.
// Parameters: intensity         Cl on the axis at distance 1, factor on lightcolor
//             lightcolor        colour of the light
//             from, to          apex of the cone and a point on its axis (shader space)
//             coneangle         half angle of the cone, radians
//             conedeltaangle    the light fades out over this angle inside the cone's edge, radians
//             beamdistribution  exponent of the cosine to the axis.
// Source: RI 3.2, Standard RenderMan Interface Shaders, Spotlight.
light spotlight(float intensity = 1; color lightcolor = 1; point from = point "shader" (0, 0, 0);
                point to = point "shader" (0, 0, 1); float coneangle = radians(30);
                float conedeltaangle = radians(5); float beamdistribution = 2;)
{
    uniform vector axis = normalize(to - from);
    uniform float cos_outer = cos(coneangle);
    uniform float cos_inner = cos(coneangle - conedeltaangle);

    illuminate(from, axis, coneangle) {
        float cos_angle = (L . axis) / length(L);
        float fading = pow(cos_angle, beamdistribution) / (L . L);
        Cl = fading * smoothstep(cos_outer, cos_inner, cos_angle) * intensity * lightcolor;
    }
}
