// SPDX-License-Identifier: Apache-2.0
/* A light with a soft cone, distance ramp and computed __nonspecular. */
light metaball_light(float intensity = 1; color lightcolor = 1; point from = point "shader" (0, 0, 0);
                     point to = point "shader" (0, 0, 1); float coneangle = radians(30), conedelta = radians(5);
                     float near = 1, far = 100; string __category = "key,soft";
                     output varying float __nonspecular = 0; output float __nondiffuse = 0;)
{
    uniform vector axis = normalize(to - from);
    illuminate(from, axis, coneangle) {
        float d = length(L);
        float cosangle = L.axis / d;
        float att = smoothstep(cos(coneangle), cos(coneangle - conedelta), cosangle);
        att *= 1 - smoothstep(near, far, d);
        __nonspecular = 1 - att;
        Cl = att * intensity * lightcolor / (d * d);
    }
}
