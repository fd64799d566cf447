// SPDX-License-Identifier: Apache-2.0
// Geometric, matrix and component functions, sl.md 4.3.
#include "slc/interp_value.h"

#include <algorithm>
#include <cmath>

namespace slc {

namespace {

using Args = std::vector<Value>&;

void put(Value& r, const Triple3& v) {
    r.x.assign(v.begin(), v.end());
}
void put(Value& r, const Matrix16& m) {
    r.x.assign(m.begin(), m.end());
}

Triple3 add3(const Triple3& a, const Triple3& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

double length3(const Triple3& a) {
    return std::hypot(a[0], a[1], a[2]);
}

std::size_t component_index(double f, std::size_t last) {
    return f > 0 ? std::min(static_cast<std::size_t>(std::min(f, 1e6)), last) : 0;
}

// Distance from Q to the segment A-B.
void ptlined(Args a, Value& r) {
    const Triple3 from = a[0].triple();
    const Triple3 along = sub3(a[1].triple(), from);
    const Triple3 to_point = sub3(a[2].triple(), from);
    const double square = dot3(along, along);
    const double t = square > 0 ? std::clamp(dot3(to_point, along) / square, 0.0, 1.0) : 0;
    r.x[0] = length3(sub3(to_point, scale3(along, t)));
}

// Rodrigues: d cos + (a ^ d) sin + a (a.d)(1 - cos)
void rotate_point(Args a, Value& r) {
    const Triple3 origin = a[2].triple();
    const Triple3 axis = normalize3(sub3(a[3].triple(), origin));
    const Triple3 d = sub3(a[0].triple(), origin);
    const double c = std::cos(a[1].f());
    const double s = std::sin(a[1].f());
    Triple3 sum = add3(scale3(d, c), scale3(cross3(axis, d), s));
    sum = add3(sum, scale3(axis, dot3(axis, d) * (1 - c)));
    put(r, add3(origin, sum));
}

// Rows are the images of the axes, found by rotating them; applied before m.
void rotate_matrix(Args a, Value& r) {
    Matrix16 rotation{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    for (std::size_t row = 0; row < 3; ++row) {
        Triple3 unit{0, 0, 0};
        unit[row] = 1;
        std::vector<Value> args = {Value(Type::Vector, unit[0], unit[1], unit[2]), a[1],
                                   Value(Type::Point, 0, 0, 0), a[2]};
        Value image = Value::zero(Type::Vector);
        rotate_point(args, image);
        std::copy(image.x.begin(), image.x.end(),
                  rotation.begin() + static_cast<std::ptrdiff_t>(4 * row));
    }
    put(r, multiply(rotation, matrix_of(a[0])));
}

Triple3 reflect3(const Triple3& i, const Triple3& n) {
    return sub3(i, scale3(n, 2 * dot3(i, n)));
}

Triple3 refract3(const Triple3& i, const Triple3& n, double eta) {
    const double c = dot3(i, n);
    const double k = 1 - eta * eta * (1 - c * c);
    if (k < 0) {
        return {0, 0, 0};
    }
    return sub3(scale3(i, eta), scale3(n, eta * c + std::sqrt(k)));
}

// Kr after sl.md 4.3; Kt = 1 - Kr.
double fresnel_reflectance(const Triple3& i, const Triple3& n, double eta) {
    const double c = std::abs(dot3(i, n));
    const double g2 = 1 / (eta * eta) - 1 + c * c;
    if (g2 < 0) {
        return 1;
    }
    const double g = std::sqrt(g2);
    const double a = (g - c) / (g + c);
    const double b = (c * (g + c) - 1) / (c * (g - c) + 1);
    return std::clamp(0.5 * a * a * (1 + b * b), 0.0, 1.0);
}

void fresnel(Args a, Value&) {
    const Triple3 i = a[0].triple();
    const Triple3 n = a[1].triple();
    const double eta = a[2].f();
    a[3] = Value(fresnel_reflectance(i, n, eta));
    a[4] = Value(1 - a[3].f());
    if (a.size() > 6) {
        put(a[5], reflect3(i, n));
        put(a[6], refract3(i, n, eta));
    }
}

void faceforward_ref(Args a, Value& r) {
    const Triple3 n = a[0].triple();
    const Triple3 reference = a[2].triple();
    const double s =
        (dot3(a[1].triple(), reference) <= 0 ? 1 : -1) * (dot3(n, reference) >= 0 ? 1 : -1);
    put(r, scale3(n, s));
}

double determinant(const Matrix16& m) {
    double sum = 0;
    for (std::size_t col = 0; col < 4; ++col) { // cofactors of the first row
        double minor[9];
        std::size_t next = 0;
        for (std::size_t i = 1; i < 4; ++i) {
            for (std::size_t j = 0; j < 4; ++j) {
                if (j != col) {
                    minor[next++] = m[4 * i + j];
                }
            }
        }
        const double d = minor[0] * (minor[4] * minor[8] - minor[5] * minor[7]) -
                         minor[1] * (minor[3] * minor[8] - minor[5] * minor[6]) +
                         minor[2] * (minor[3] * minor[7] - minor[4] * minor[6]);
        sum += (col % 2 == 0 ? 1 : -1) * m[col] * d;
    }
    return sum;
}

template <std::size_t I> void get_component(Args a, Value& r) {
    r.x[0] = a[0].at(I);
}
template <std::size_t I> void set_component(Args a, Value&) {
    a[0].x[I] = a[1].f();
}

} // namespace

std::vector<PureEntry> pure_geometry() {
    return {
        {"xcomp", get_component<0>},
        {"ycomp", get_component<1>},
        {"zcomp", get_component<2>},
        {"setxcomp", set_component<0>},
        {"setycomp", set_component<1>},
        {"setzcomp", set_component<2>},
        {"length", [](Args a, Value& r) { r.x[0] = length3(a[0].triple()); }},
        {"distance",
         [](Args a, Value& r) { r.x[0] = length3(sub3(a[0].triple(), a[1].triple())); }},
        {"normalize", [](Args a, Value& r) { put(r, normalize3(a[0].triple())); }},
        {"ptlined", ptlined},
        {"rotate_3", rotate_point},
        {"rotate_m", rotate_matrix},
        {"reflect", [](Args a, Value& r) { put(r, reflect3(a[0].triple(), a[1].triple())); }},
        {"refract",
         [](Args a, Value& r) { put(r, refract3(a[0].triple(), a[1].triple(), a[2].f())); }},
        {"fresnel", fresnel},
        {"fresnel_rt", fresnel},
        {"faceforward_ref", faceforward_ref},
        {"transform_m",
         [](Args a, Value& r) {
             put(r, transform_by(Type::Point, a[1].triple(), matrix_of(a[0])));
         }},
        {"vtransform_m",
         [](Args a, Value& r) {
             put(r, transform_by(Type::Vector, a[1].triple(), matrix_of(a[0])));
         }},
        {"ntransform_m",
         [](Args a, Value& r) {
             put(r, transform_by(Type::Normal, a[1].triple(), matrix_of(a[0])));
         }},
        {"determinant", [](Args a, Value& r) { r.x[0] = determinant(matrix_of(a[0])); }},
        {"translate_m",
         [](Args a, Value& r) {
             const Triple3 d = a[1].triple();
             put(r, multiply({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, d[0], d[1], d[2], 1},
                             matrix_of(a[0])));
         }},
        {"scale_m",
         [](Args a, Value& r) {
             const Triple3 s = a[1].triple();
             put(r, multiply({s[0], 0, 0, 0, 0, s[1], 0, 0, 0, 0, s[2], 0, 0, 0, 0, 1},
                             matrix_of(a[0])));
         }},
        {"comp_m",
         [](Args a, Value& r) {
             r.x[0] =
                 matrix_of(a[0])[4 * component_index(a[1].f(), 3) + component_index(a[2].f(), 3)];
         }},
        {"setcomp_m",
         [](Args a, Value&) {
             a[0].x[4 * component_index(a[1].f(), 3) + component_index(a[2].f(), 3)] = a[3].f();
         }},
        {"comp_3", [](Args a, Value& r) { r.x[0] = a[0].at(component_index(a[1].f(), 2)); }},
        {"setcomp_3", [](Args a, Value&) { a[0].x[component_index(a[1].f(), 2)] = a[2].f(); }},
    };
}

} // namespace slc
