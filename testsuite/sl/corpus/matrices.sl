// SPDX-License-Identifier: Apache-2.0
/* Matrices by all means: casts with spaces, products, inverse, translate, rotate, scale, comp, transform by matrix. */
surface matrices(matrix own = matrix "shader" 1; float turn = .5; float m16[16] = {1,0,0,0, 0,2,0,0, 0,0,1,0, .1,.2,.3,1};)
{
    matrix m = matrix (m16[0], m16[1], m16[2], m16[3], m16[4], m16[5], m16[6], m16[7],
                       m16[8], m16[9], m16[10], m16[11], m16[12], m16[13], m16[14], m16[15]);
    matrix w = matrix "world" 1;
    m = rotate(m, turn, vector (0, 0, 1));
    m = scale(translate(m, vector (.1, 0, 0)), point (1, 1.5, 1));
    m *= 1 / (own * 1);
    setcomp(m, 3, 0, comp(m, 3, 0) + .1);
    point Q = transform(m, P);
    Q = transform("shader", m, Q);
    vector V = vtransform(w, I);
    normal M = ntransform(m, N);
    float det = determinant(m / w);
    color c = color (mod(xcomp(Q), 1), mod(ycomp(Q), 1), abs(zcomp(normalize(M))));
    if (m == w || own != 1)
        c *= .9;
    Ci = Os * c * (det == 0 ? 0 : 1) * (length(V) > 0 ? 1 : 0);
    Oi = Os;
}
