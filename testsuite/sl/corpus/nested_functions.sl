// SPDX-License-Identifier: Apache-2.0
/* Nested functions that see formals and locals of the function around them through extern. */
float outer_scale(float amount; vector dir)
{
    float jitter = amount * 2;
    float sqr_of(float x) { return x * x; };
    vector spread(float k)
    {
        extern float jitter;
        extern vector dir;
        return dir * (k * jitter);
    }
    vector v = spread(0.5) + spread(0.25);
    return sqr_of(length(v)) / max(sqr_of(amount), 1e-6);
}

surface nested_functions(float Kd = 1; uniform float levels = 3)
{
    extern color Cs;
    float total = 0;
    float weight(float i) { extern uniform float levels; return 1 - i / levels; }
    uniform float i;
    for (i = 0; i < levels; i += 1)
        total += weight(i) * outer_scale(i + 1, normalize(I));
    Oi = Os;
    Ci = Oi * Cs * Kd * total;
}
