// SPDX-License-Identifier: Apache-2.0
/* Screw threads: a spiral of sines, faded at both ends. Old style: phase by magic numbers, P moved along N. */
displacement
threads ( float Km = .1;
          float frequency = 5.0;
          float phase = .0;
          float offset = .0;
          float dampzone = .05; )
{
    float magnitude;
    point PP;
    magnitude = (sin( PI*2*(t*frequency + s + phase))+offset) * Km;
    if( t > (1-dampzone))
        magnitude *= (1.0-t) / dampzone;
    else if( t < dampzone )
        magnitude *= t / dampzone;
    PP = P + normalize(N)*magnitude;
    P = PP;
    N = normalize(calculatenormal(P));
}
