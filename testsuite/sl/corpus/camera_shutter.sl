// SPDX-License-Identifier: Apache-2.0
/* Time, eye and every other predefined variable that shaders rarely read. */
surface camera_shutter(float shutter = 1)
{
    float fade = dtime > 0 ? clamp(time / dtime, 0, 1) : 1;
    vector speed = dPdtime;
    float facing = normalize(P - E) . normalize(I);
    color c = color (mod(u * 10, 1), mod(v * 10, 1), abs(facing)) * (fade + length(speed) * shutter);
    float size = sqrt(area(P)) / (1 + length(dPdu ^ dPdv) * du * dv);
    if (ncomps == 3)
        c += Ng . normalize(N) > 0 ? 0 : .1;
    Ci = Os * c * (.9 + .1 * clamp(size, 0, 1));
    Oi = Os;
}
