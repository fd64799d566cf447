// SPDX-License-Identifier: Apache-2.0
/* Header-like macros: parameters by macro giving ;;, statements, declarations in loops, stringise, paste, nested conditionals. */
#ifndef USE_PREF
#define USE_PREF 0
#endif
#define STDPARAMS float Ka = 1, Kd = .8; float Ks = .2, roughness = .1
#define LAYERPARAMS(n) float amount##n = .5, freq##n = n * 2; color color##n = color (n / 3, .5, 1 - n / 3);
#define COMPOSITE(dst, c, k) { color _c = (c); float _k = (k); dst = mix(dst, _c, _k); }
#define DO_LAYER(n) COMPOSITE(Ct, color##n, amount##n * step(.5, mod(freq##n * s, 1)))
#define DEBUG_NAME(x) #x
#define SQR(x) ((x) * (x))
#if !defined(TWOPI) && \
    (USE_PREF == 0)
#   define TWOPI (2 * PI)
#else
#   error "not here"
#endif
surface macro_library(STDPARAMS;; LAYERPARAMS(1); LAYERPARAMS(2); string debug = "";)
{
    color Ct = Cs;
    DO_LAYER(1);
    DO_LAYER(2)
    if (USE_PREF)
        Ct = 0;
    if (debug == DEBUG_NAME(macro_library)) printf("%s: %f %c\n", debug, SQR(s), Ct);
    normal Nf = faceforward(normalize(N), I);
    float wave = .5 + .5 * sin(TWOPI * 3 * t);
    Oi = Os;
    Ci = Os * (Ct * wave * (Ka * ambient() + Kd * diffuse(Nf)) + Ks * specular(Nf, -normalize(I), roughness));
}
