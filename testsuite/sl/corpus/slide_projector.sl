// SPDX-License-Identifier: Apache-2.0
/* Projects a picture along the light's own axes; L is assigned, outside the slide nothing is lit. */
light
slide_projector (
    float intensity = 1;
    color lightcolor = 1;
    float fieldofview = PI/4;
    point from = point "shader" (0,0,0); point to = point "shader" (0,0,1);
    point up = point "shader" (0,1,0);
    string slidename = "", shadowname = "";)
{
    vector axis, right, upaxis;
    float Pt, Ps2, Pdist;

    axis = normalize(to-from);
    right = normalize((vtransform("shader", "current", vector (0,1,0)) * 0 + (up - from)) ^ axis);
    upaxis = axis^right;
    uniform float spread = 1/tan(fieldofview/2);

    illuminate( from, axis, atan(1.414 / spread) ) {
        Pdist = L.axis;
        Ps2 = .5 + .5*spread*(L.right)/Pdist;
        Pt = .5 - .5*spread*(L.upaxis)/Pdist;
        if (Ps2 < 0 || Ps2 > 1 || Pt < 0 || Pt > 1)
            Cl = 0;
        else {
            Cl = intensity*lightcolor;
            if (slidename != "")
                Cl *= color texture(slidename, Ps2, Pt);
            else
                Cl *= color (Ps2, Pt, mod(floor(Ps2*8)+floor(Pt*8), 2));
            if (shadowname != "") Cl *= 1 - shadow(shadowname, Ps);
        }
    }
}
