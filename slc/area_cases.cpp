// SPDX-License-Identifier: Apache-2.0
#include "slc/area_cases.h"

namespace slc {

namespace {

constexpr AreaCase cases[] = {
    {"Operators", "r = Du(s * t + w) + 3 * Dv(s / (t + 2)) - Deriv(s * s, t); q = Du(P ^ N) + "
                  "Dv(P * s) + Deriv(P, s); r += area(P * k) + Du(P . N);"},
    {"KnownValues", "r = Du(u) + 10 * Dv(u) + 100 * Dv(v) + 1000 * Du(v) + Du(k) + Du(3);"},
    {"Parameter", "r = Du(w * w) + 2 * Dv(w);"},
    {"Functions", "r = Du(sin(s) * exp(t) + pow(abs(s), t)) + Dv(smoothstep(0, 2, s * t)) + "
                  "Du(mix(s, t, u)) + Dv(clamp(s, .3, t)) + Du(min(s, t, u, .9)) + "
                  "Dv(atan(s, t)) + Du(mod(s * 7, 1)); q = Du(normalize(P)) + Dv(mix(P, N, s)) "
                  "+ Du(reflect(I, normalize(N))) + Dv(max(P, N, I));"},
    {"Noise", "r = Du(noise(P * 3)) + Dv(noise(s, t)) + Du(cellnoise(s * 9)); q = Du(vector "
              "noise(P)) + Dv(vector noise(s, t));"},
    {"Splines", "r = Du(spline(s, 0, .2, .7, .3, 1)) + Dv(spline(t, s, t, u, v, s)); float "
                "a[5] = {0, 1, .5, 2, 1}; a[2] = s; r += Du(spline(t, a));"},
    {"Spaces", "q = Du(transform(\"shader\", P)) + Dv(vtransform(\"object\", N)) + Du(vector "
               "ntransform(\"world\", N)); matrix m = translate(1, vector (s, t, u)); q += "
               "Dv(transform(m, P)); r = Du(comp(m * m, 3, 1)) + Dv(determinant(m / (m * m)));"},
    {"Faceforward", "q = Du(faceforward(N, I)) + Dv(faceforward(vector N, I, Ng));"},
    {"Fresnel", "float kr, kt; vector R, T; fresnel(normalize(I), normalize(N), 1.5, kr, kt, R, "
                "T); r = Du(kr) + Dv(kt); q = Du(R) + Dv(T);"},
    {"Components", "point p = P; setxcomp(p, s * t); p[1] = 2 * s; q = Du(p) + Dv(p); r = "
                   "Du(xcomp(P)) + Dv(ycomp(p)) + Du(comp(color (s, t, u), floor(t * 3)));"},
    {"Colours", "color c = ctransform(\"hsv\", color (s * .3, t * .3, u)); q = vector Du(c * Cs) + "
                "vector Dv(color \"hsv\" (s, t, .5));"},
    {"CompoundAssignment", "float x = s; x *= x; x += t; x /= 3 + x; x -= u; r = Du(x) + Dv(x);"},
    {"Select", "float x = s > t ? s * s : t; r = Du(x) + Dv(s < .9 ? P . N : 2); q = Du(s > 1 ? "
               "P : point N);"},
    {"Comparison", "float x = s > t; float y = (s < .8 && t > .3) || !(u < .2); r = Du(x) + 2 * "
                   "Dv(y) + Du(x * y) + Dv(P == P) + Du(Cs != color (.9));"},
    {"If", "float x = t; if (s > .9) x = s * s; r = Du(x) + Dv(x);"},
    {"IfElse", "float x, y = 1; if (s > .9) { x = s; y = t * x; } else { x = 2 * t; } r = Du(x) + "
               "Dv(y * x);"},
    {"NestedIf", "float x = u; if (s > .7) { x += t; if (t > .9) { x *= s; } else if (v > .6) { x "
                 "-= 1; } x += u; } r = Du(x) + 3 * Dv(x);"},
    {"OperatorInIf", "if (s > .9) { r = Du(t * s); q = Dv(P * s); } else { r = 5 * Dv(s * u); }"},
    {"OperatorAfterChangeInIf",
     "float x = s; if (t > .9) { x = x * x + 1; r = Du(x); } else { x += 2 * t; r = Dv(x * t); } "
     "r += 10 * Du(x);"},
    {"OperatorInNestedIf", "float x = s; if (t > .8) { x *= 2; if (s > .9) { x += u; r = Du(x); } "
                           "x += t; r += Dv(x); } r += Du(x);"},
    {"UniformControl", "float x = s; if (k > .5) { x *= t; if (name == \"\") r = Du(x); else r = "
                       "Dv(x); } else x = 1; r += 2 * Dv(x);"},
    {"Loop", "float i, x = 0; for (i = 0; i < 4; i += 1) { x += noise(s * i) * t; } r = Du(x) + "
             "Dv(x);"},
    {"OperatorInLoop", "float i, x = s; for (i = 0; i < 3; i += 1) { x = x * x + t; r += Du(x) * "
                       "i; }"},
    {"VaryingLoop", "float x = 0, y = s; while (y < 2) { y += .4 * t; x += y * u; } r = Du(x) + "
                    "Dv(y);"},
    {"OperatorInVaryingLoop", "float y = s; while (y < 2) { y += .4 * t + .01; r += Du(y * y); } "
                              "r += 10 * Dv(y);"},
    {"Break", "float i, x = 0; for (i = 0; i < 5; i += 1) { x += s * i; if (x > 2) break; x += t; "
              "} r = Du(x) + Dv(x);"},
    {"OperatorAfterBreak", "float i, x = 0; for (i = 0; i < 5; i += 1) { x += s; if (x > 2) { x = "
                           "x * 3; break; } x += t; r += Du(x); } r += 7 * Du(x);"},
    {"Continue", "float i, x = 0, y = 1; for (i = 0; i < 5; i += 1) { x += s; if (mod(x, 1) > .5) "
                 "{ x += .1 * t; continue; } y += x; } r = Du(x) + Dv(y) + Du(y);"},
    {"OperatorAfterContinue", "float i, x = 0; for (i = 0; i < 5; i += 1) { x += s; if (mod(x, 1) "
                              "> .5) continue; r += Du(x * t); x += .1; } r += Dv(x);"},
    {"NestedLoops", "float i, j, x = 0; for (i = 0; i < 3; i += 1) { for (j = 0; j < 3; j += 1) { "
                    "x += s * t; if (x > 1.5) break; if (mod(x, .5) > .3) continue; x += .2 * u; "
                    "} x *= .8; } r = Du(x) + Dv(x);"},
    {"BreakTwoLevels", "float i, j, x = 0; for (i = 0; i < 3; i += 1) { for (j = 0; j < 3; j += "
                       "1) { x += s * t; if (x > 1.5) break 2; r += Du(x); } x *= .8; } r += Du(x) "
                       "+ Dv(x);"},
    {"EarlyReturn", "r = Du(f(s)) + Dv(f(t)) + Du(f(f(s * t)));",
     "float f(float x) { if (x > .8) return x * x; float y = 1 - x; if (y > .5) return y; return "
     "x + y * x; } "},
    {"ReturnInLoop", "r = Du(f(s)) + 2 * Dv(f(t));",
     "float f(float x) { float i, y = x; for (i = 0; i < 4; i += 1) { y = y * 1.3; if (y > 1.4) "
     "return y * i; } return y; } "},
    {"OperatorInFunction", "r = width(s * t) + width(noise(P)); if (s > .9) r += width(t);",
     "float width(float x) { return max(abs(Du(x) * du) + abs(Dv(x) * dv), 1e-6); } "},
    {"ReturnFromShader", "float x = s; if (t > .9) { x = 2 * u; if (s > .9) return; x += s; } r = "
                         "Du(x); x = x * x; r += Dv(x);"},
    {"OutputParameters", "float a, b; split(s, a, b); r = Du(a) + Dv(b);",
     "void split(float x; output float a, b;) { a = x * x; if (x > .9) b = a; else b = 1 - a; } "},
    {"NestedFunctions", "float g(float x) { float h(float y) { return y * y + s; } return h(x) * "
                        "h(t); } r = Du(g(u)) + Dv(g(s));"},
    {"Arrays", "float a[4]; a[0] = s; a[1] = t; a[2] = a[0] * a[1]; a[3] = u; float i; for (i = "
               "0; i < 4; i += 1) a[i] = a[i] * a[3 - i]; r = Du(a[1]) + Dv(a[2]);"},
    {"VaryingIndex", "float a[3] = {1, 2, 3}; a[1] = s; a[floor(s * 3)] = t * 2; r = Du(a[floor(t "
                     "* 3)]) + Dv(a[1]) + Du(a[0]);"},
    {"ArrayInIf", "point a[2]; a[0] = P; a[1] = point N; if (s > .9) { a[0] = a[1] * s; a[1] = "
                  "0; } q = Du(a[0]) + Dv(a[1]);"},
    {"ArrayCopies", "float a[3], b[3]; a[0] = s; a[1] = t; a[2] = 1; b = a; if (t > .9) b[1] = "
                    "s; r = Du(b[0] * b[1]) + Dv(b[2]);"},
    {"Globals",
     "P += .1 * s * N; N = calculatenormal(P); s *= 3; t = s * t; q = vector N + Du(P); r "
     "= Du(s) + Dv(t);"},
    {"GlobalsInIf", "if (s > .9) { P = P + N * t; s = 2 * s; } q = Du(P) + Dv(P); r = Du(s);"},
    {"BumpIdiom", "normal n = normalize(N); point PP = P + .1 * noise(P * 2) * n; q = vector "
                  "calculatenormal(PP);"},
    {"Calculatenormal", "q = vector calculatenormal(P * k);"},
    {"SecondOrder", "point PP = P + .1 * s * N; vector R = reflect(I, normalize(calculatenormal("
                    "PP))); q = Du(R) + Dv(R);"},
    {"DerivativeOfDerivative", "r = Du(s * Du(s * t)) + Dv(Dv(s * s) * t);"},
    {"FilterStep", "r = filterstep(.9, s) + 2 * filterstep(s, t) + filterstep(.5, s * t);"},
    {"DerivativeOfFilterStep", "r = Du(filterstep(.9, s)) + Dv(filterstep(s, t));"},
    {"Random", "float x = random(); r = Du(x * s) / (x + .001);"},
    {"Lighting", "color c = diffuse(N) + ambient(); q = vector Du(c * s) + vector Dv(c);"},
    {"Illuminance", "float x = s; illuminance(P) { x += .5; if (u > .2) x *= t; } r = Du(x) + "
                    "Dv(x);"},
    {"OperatorInIlluminance", "illuminance(P) { r += Du(s * t) * comp(Cl, 0); }"},
    {"BreakInIlluminance", "float x = s; illuminance(P) { x *= 1.5; if (x > 1.4) break; x += t; } "
                           "r = Du(x) + Dv(x);"},
    {"Messages", "float x = s; float found = surface(\"known\", x); r = Du(x) + found * Dv(s);"},
    {"Logical", "float x = (noise(s) > .4 && noise(t) > .5 ? s : t); r = Du(x); if (s > .5 && "
                "noise(P) > .4) r += Dv(s * t);"},
    {"Pattern",
     "float w2 = width(s * 4); float ss = mod(s * 4, 1); r = pulse(.3, .6, ss, w2); r += Du(r * "
     "u);",
     "float width(float x) { return max(abs(Du(x) * du) + abs(Dv(x) * dv), 1e-6); } "
     "float pulse(float a, b, x, fw) { float x0 = x - fw * .5; float x1 = x0 + fw; return max(0, "
     "(min(x1, b) - max(x0, a)) / fw); } "},
    {"Fbm", "r = fbm(P * 2, 5, 2, .5); r += Du(r);",
     "float size(point p) { return sqrt(area(p)); } float fbm(point p; float octaves, lacunarity, "
     "gain;) { float sum = 0, amp = 1, i; point pp = p; float fw = size(p); for (i = 0; i < "
     "octaves; i += 1) { if (fw > 1) break; sum += amp * (noise(pp) * (1 - smoothstep(.2, .6, fw)) "
     "+ .5 * smoothstep(.2, .6, fw)); amp *= gain; pp *= lacunarity; fw *= lacunarity; } return "
     "sum; } "},
};

// Differences along a step, as a batch holds them.
float step_of(int variable, int component, int point, int aux) {
    return 0.0625F *
           OracleWorld::input(static_cast<std::size_t>(variable + 40 * aux), component, point);
}

double component_of(int variable, int component, int point, int aux) {
    switch (variable) {
    case SL_VAR_u:
        return 0.003 + 0.01 * point + (aux == 1 ? component_of(SL_VAR_du, 0, point, 0) : 0);
    case SL_VAR_v:
        return 0.5 + 0.013 * point + (aux == 2 ? component_of(SL_VAR_dv, 0, point, 0) : 0);
    case SL_VAR_du:
    case SL_VAR_dv:
        return 0.03125 + (point % 5) * 0.015625;
    default: {
        const float here = OracleWorld::input(static_cast<std::size_t>(variable), component, point);
        const bool moves = aux != 0 && axes_of_global(SL_SHADER_surface, variable) != NoAxis;
        return static_cast<double>(here) +
               (moves ? static_cast<double>(step_of(variable, component, point, aux)) : 0.0);
    }
    }
}

} // namespace

std::string AreaCase::text() const {
    return std::string(functions) +
           "surface t(output varying float r = 0; output varying vector q = 0; "
           "varying float w = 0; uniform float k = 0.75; string name = \"\") { " +
           body + " }";
}

std::span<const AreaCase> area_cases() {
    return cases;
}

Value area_input(int variable, int point, int aux) {
    const VariableRow& row = variable_rows()[static_cast<std::size_t>(variable)];
    Value v = Value::zero(row.type);
    for (int k = 0; k < num_components(row.type); ++k) {
        v.x[static_cast<std::size_t>(k)] =
            component_of(variable, k, row.detail == Detail::Uniform ? 0 : point, aux);
    }
    return v;
}

double area_param(const Program&, const Param& p, int point, int aux) {
    return static_cast<double>(OracleWorld::input(70 + static_cast<std::size_t>(p.var), 0, point)) +
           0.03125 * aux;
}

void set_area_inputs(const Program& program, Interpreter& interpreter, int point, int aux) {
    for (int id = 0; id < SL_VAR_COUNT; ++id) {
        interpreter.set_global(id, 0, area_input(id, point, aux));
    }
    for (const Param& p : program.params) {
        const Var& v = program.vars[static_cast<std::size_t>(p.var)];
        if (v.detail == Detail::Varying && !v.is_output && v.type == Type::Float) {
            interpreter.set_param(v.name, 0, Value(area_param(program, p, point, aux)));
        }
    }
}

} // namespace slc
