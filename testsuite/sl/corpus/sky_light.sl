// SPDX-License-Identifier: Apache-2.0
// solar without arguments: light from every direction; Cl is changed after the block.
light sky_light(float intensity = 1; color zenith = (.3, .5, 1), horizon = 1; string shadowname = "";)
{
    vector up = vector "world" (0, 0, 1);
    solar() {
        float k = clamp(normalize(-L).normalize(up), 0, 1);
        Cl = mix(horizon, zenith, k);
        if (shadowname != "")
            Cl *= 1 - shadow(shadowname, Ps, "samples", 4, "blur", .01);
    }
    Cl *= intensity;
}
