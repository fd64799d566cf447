// SPDX-License-Identifier: Apache-2.0
/* Lights edges only, by the eye and the normal of the lit surface; marked for user loops by output parameters. */
light rim_light(float intensity = 1, width = 8; color lightcolor = 1; point from = point "eye" (0, 0, 0);
                output uniform float __rimlight = 1; output varying float __nonspecular = 1; string __lightname = "rim";)
{
    float weight(float x) { extern float width; return pow(1 - abs(x), width); }
    illuminate (from) {
        vector V = normalize(E - Ps);
        Cl = intensity * lightcolor * weight(normalize(Ns) . V);
    }
}
