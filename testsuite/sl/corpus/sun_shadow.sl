// SPDX-License-Identifier: Apache-2.0
// warns: parameter '__inshadow' is assigned a varying value
/* Distant light with up to four shadow maps of decreasing size in an array of strings, the first that covers P wins. */
light sun_shadow(float intensity = 1, samples = 16, blur = .01, bias = -1; color lightcolor = 1;
                 point from = point "shader" (0, 0, 0), to = point "shader" (0, 0, 1);
                 string shadownames[3] = {"", "", ""}; output float __inshadow = 0;)
{
    solar (to - from, 0) {
        uniform float i = 0;
        uniform float searching = 1;
        float dark = 0;
        while (i < 3 && searching == 1) {
            if (shadownames[i] != "") {
                if (bias >= 0)
                    dark = shadow(shadownames[i], Ps, "samples", samples, "blur", blur, "bias", bias);
                else
                    dark = shadow(shadownames[i], Ps, "samples", samples, "swidth", 1, "twidth", 1);
                searching = 0;
            }
            i = i + 1;
        }
        __inshadow = dark;
        Cl = intensity * lightcolor * (1 - dark);
    }
}
