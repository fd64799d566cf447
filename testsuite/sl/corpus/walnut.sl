// SPDX-License-Identifier: Apache-2.0
/* Wood of the first generation: everything point, one big expression, transform to "shader", spline of colours. */
surface
walnut ( float Ka = 1, Kd = .75, Ks = .4, roughness = .1;
         color specularcolor = 1;
         float ringscale = 15, grainy = 1; )
{
    point NN, V, PP, PQ;
    float my_t, r, r2;
    color Ct;

    PP = transform("shader", P) * ringscale;
    PQ = point (xcomp(PP)*8, ycomp(PP)*8, zcomp(PP));
    my_t = zcomp(PP) / ringscale;
    PP = point (xcomp(PP), ycomp(PP), my_t);
    PP = PP + noise(PP)/10;
    r = sqrt (ycomp(PP)*ycomp(PP) + zcomp(PP)*zcomp(PP));
    r = r + abs(noise(r) * noise(PQ));
    r = mod (r, 1);
    r2 = smoothstep (.2, .55, r) - smoothstep (.75, .8, r);
    Ct = spline (r2, color "rgb" (.55,.31,.15), color "rgb" (.55,.31,.15), color "rgb" (.4,.2,.08),
                 color "rgb" (.22,.09,.03), color "rgb" (.2,.08,.02));
    Ct *= 1 - .3*grainy*noise(PQ);

    NN = normalize(faceforward(N,I));
    V = -normalize(I);
    Oi = Os;
    Ci = Os * (Ct * (Ka*ambient() + Kd*diffuse(NN)) + specularcolor * Ks*specular(NN,V,roughness));
}
