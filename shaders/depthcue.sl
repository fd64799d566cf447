// SPDX-License-Identifier: Apache-2.0
// depthcue: mixes in a background colour with depth, for drawings that should look deep.
// Parameters: mindistance, maxdistance  depths where it begins and is complete; 0 is the near, 1 the far clipping
//                                       plane (Clipping)
//             background                colour of what is far away.
// Source: RI 3.2, Standard RenderMan Interface Shaders, Depth Cue.
volume depthcue(float mindistance = 0; float maxdistance = 1; color background = 0;)
{
    float d = clamp((depth(P) - mindistance) / (maxdistance - mindistance), 0, 1);

    Ci = mix(Ci, background, d);
}
