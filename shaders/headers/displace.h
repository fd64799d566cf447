/* SPDX-License-Identifier: Apache-2.0
 * Displacement and bump mapping by one call. Written for Perigee to the names that published shaders expect. */
#ifndef DISPLACE_H
#define DISPLACE_H 1

/* Moves P along dir by amp, lengths in `space`; truedisp 0 bends only the normal. Returns the new normal. */
normal Displace(vector dir; string space; float amp; float truedisp)
{
    extern point P;
    extern normal N, Ng;
    float spacescale = length(vtransform(space, dir));
    vector Ndisp = dir * (amp / max(spacescale, 1e-6));
    point Pbump = P + Ndisp;
    if (truedisp != 0)
        P += truedisp * Ndisp;
    normal Nnew = normalize(calculatenormal(Pbump));
    /* keep what smooth normals add to flat facets */
    return normalize(Nnew + (normalize(N) - normalize(Ng)));
}

#endif
