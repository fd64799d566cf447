// SPDX-License-Identifier: Apache-2.0
// Compares P, dPdu and dPdv with a bicubic Bezier (or, with order 2, bilinear) patch evaluated at the shader's (u, v).
// Parameters: order  4 or 2 control points a side
//             cp     their coordinates, u fastest.
// Writes (error of P, error of dPdu, error of dPdv), object space.
surface bicubic_error(float order = 4; float cp[48] = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
                                                        0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};)
{
    float bu[4], bv[4], du_[4], dv_[4];
    if (order == 4) {
        bu[0] = (1 - u) * (1 - u) * (1 - u); bu[1] = 3 * u * (1 - u) * (1 - u); bu[2] = 3 * u * u * (1 - u); bu[3] = u * u * u;
        bv[0] = (1 - v) * (1 - v) * (1 - v); bv[1] = 3 * v * (1 - v) * (1 - v); bv[2] = 3 * v * v * (1 - v); bv[3] = v * v * v;
        du_[0] = -3 * (1 - u) * (1 - u); du_[1] = 3 * (1 - u) * (1 - 3 * u); du_[2] = 3 * u * (2 - 3 * u); du_[3] = 3 * u * u;
        dv_[0] = -3 * (1 - v) * (1 - v); dv_[1] = 3 * (1 - v) * (1 - 3 * v); dv_[2] = 3 * v * (2 - 3 * v); dv_[3] = 3 * v * v;
    } else {
        bu[0] = 1 - u; bu[1] = u; bv[0] = 1 - v; bv[1] = v;
        du_[0] = -1; du_[1] = 1; dv_[0] = -1; dv_[1] = 1;
    }
    vector p = 0, pu = 0, pv = 0;
    uniform float i, j;
    for (j = 0; j < order; j += 1)
        for (i = 0; i < order; i += 1) {
            uniform float k = 3 * (j * order + i);
            vector c = vector(cp[k], cp[k + 1], cp[k + 2]);
            p += bu[i] * bv[j] * c;
            pu += du_[i] * bv[j] * c;
            pv += bu[i] * dv_[j] * c;
        }
    Oi = 1;
    Ci = color(length(vector transform("object", P) - p), length(vtransform("object", dPdu) - pu),
               length(vtransform("object", dPdv) - pv));
}
