// SPDX-License-Identifier: Apache-2.0
// Compares P, dPdu, dPdv and N with the equations of the quadric (RI 3.2, Quadrics), evaluated at the shader's own
// (u, v) in object space. Writes (error of P, relative error of dPdu and dPdv, error of the unit normal), so that a
// case only states a bound.
// Parameters: kind  0 sphere, 1 cone, 2 cylinder, 3 hyperboloid, 4 paraboloid, 5 disk, 6 torus
//             args  the numbers of the request, angles in degrees.
surface quadric_error(float kind = 0; float args[7] = {1, -1, 1, 360, 0, 0, 0};)
{
    // The profile: radius r and height z over v, and their derivatives; sweep is theta at u = 1, turn its phase.
    float r = 0, z = 0, dr = 0, dz = 0, turn = 0, dturn = 0, sweep = 0;
    if (kind == 0) {
        float low = args[1] > -args[0] ? asin(args[1] / args[0]) : -PI / 2;
        float high = args[2] < args[0] ? asin(args[2] / args[0]) : PI / 2;
        float phi = low + v * (high - low);
        r = args[0] * cos(phi); z = args[0] * sin(phi);
        dr = -args[0] * sin(phi) * (high - low); dz = args[0] * cos(phi) * (high - low);
        sweep = radians(args[3]);
    } else if (kind == 1) {
        r = args[1] * (1 - v); z = v * args[0];
        dr = -args[1]; dz = args[0];
        sweep = radians(args[2]);
    } else if (kind == 2) {
        r = args[0]; z = mix(args[1], args[2], v);
        dz = args[2] - args[1];
        sweep = radians(args[3]);
    } else if (kind == 3) {
        float x = mix(args[0], args[3], v), y = mix(args[1], args[4], v);
        float dx = args[3] - args[0], dy = args[4] - args[1];
        r = sqrt(x * x + y * y); z = mix(args[2], args[5], v);
        dr = (x * dx + y * dy) / r; dz = args[5] - args[2];
        turn = atan(y, x); dturn = (x * dy - y * dx) / (r * r);
        sweep = radians(args[6]);
    } else if (kind == 4) {
        z = mix(args[1], args[2], v); r = args[0] * sqrt(z / args[2]);
        dz = args[2] - args[1]; dr = r > 0 ? args[0] * args[0] * dz / (2 * args[2] * r) : 0;
        sweep = radians(args[3]);
    } else if (kind == 5) {
        r = args[1] * (1 - v); z = args[0];
        dr = -args[1];
        sweep = radians(args[2]);
    } else {
        float phi = radians(mix(args[2], args[3], v));
        float dphi = radians(args[3] - args[2]);
        r = args[0] + args[1] * cos(phi); z = args[1] * sin(phi);
        dr = -args[1] * sin(phi) * dphi; dz = args[1] * cos(phi) * dphi;
        sweep = radians(args[4]);
    }
    float theta = u * sweep + turn;
    float c = cos(theta), s1 = sin(theta);
    point wantP = point(r * c, r * s1, z);
    vector wantU = vector(-r * s1, r * c, 0) * sweep;
    vector wantV = vector(dr * c - r * s1 * dturn, dr * s1 + r * c * dturn, dz);
    // The profile's normal does not vanish at poles and tips, where the cross product of the derivatives does.
    vector around = vector(-s1, c, 0);
    vector wantN = normalize((around ^ wantV) * sign(sweep));

    vector gotU = vtransform("object", dPdu), gotV = vtransform("object", dPdv);
    vector gotN = normalize(vector ntransform("object", N));
    float scaleU = max(length(wantU), .1), scaleV = max(length(wantV), .1);
    Oi = 1;
    Ci = color(distance(transform("object", P), wantP),
               max(length(gotU - wantU) / scaleU, length(gotV - wantV) / scaleV), length(gotN - wantN));
}
