// SPDX-License-Identifier: Apache-2.0
// Every area operator, some in conditions, some in functions called in a loop.
float width_of(float x) { extern float du, dv; return abs(Du(x) * du) + abs(Dv(x) * dv); }
surface derivatives(uniform float n = 3; string envmap = "")
{
    uniform float i;
    float w = 0;
    for (i = 1; i <= n; i += 1)
        w += width_of(noise(s * i));
    vector along = Du(P) + Dv(vector N) + Deriv(P, s);
    color cd = Du(Cs) + Deriv(Cs, t);
    normal Nn = calculatenormal(P + noise(P) * N);
    if (w > .1)
        w = area(P) + area(P, "dicing");
    if (envmap != "")
        cd += environment(envmap, reflect(I, Nn));
    Ci = cd * w * length(along) * length(Nn);
    Oi = 1;
}
