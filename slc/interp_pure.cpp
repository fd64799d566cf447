// SPDX-License-Identifier: Apache-2.0
// The table of pure functions and the arithmetic they share.
#include "slc/interp_value.h"

#include <cmath>
#include <unordered_map>

namespace slc {

Value Value::zero(Type type, int array_length) {
    Value v;
    v.type = type;
    const auto elements = static_cast<std::size_t>(array_length == 0 ? 1 : array_length);
    if (type == Type::String) {
        v.x.clear();
        v.s.assign(elements, "");
    } else {
        v.x.assign(elements * static_cast<std::size_t>(num_components(type)), 0.0);
    }
    return v;
}

const std::string& Value::text() const {
    static const std::string empty;
    return s.empty() ? empty : s[0];
}

PureFunction pure_function(std::string_view body) {
    static const std::unordered_map<std::string_view, PureFunction> table = [] {
        std::unordered_map<std::string_view, PureFunction> all;
        for (const auto& part : {pure_math(), pure_geometry(), pure_noise(), pure_text()}) {
            for (const PureEntry& e : part) {
                all.emplace(e.body, e.function);
            }
        }
        return all;
    }();
    const auto it = table.find(body);
    return it == table.end() ? nullptr : it->second;
}

double dot3(const Triple3& a, const Triple3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Triple3 cross3(const Triple3& a, const Triple3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Triple3 sub3(const Triple3& a, const Triple3& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

Triple3 scale3(const Triple3& a, double f) {
    return {a[0] * f, a[1] * f, a[2] * f};
}

Triple3 normalize3(const Triple3& a) {
    const double length = std::hypot(a[0], a[1], a[2]);
    return length > 0 ? scale3(a, 1 / length) : Triple3{0, 0, 0};
}

Matrix16 matrix_of(const Value& v) {
    Matrix16 m{};
    for (std::size_t i = 0; i < 16; ++i) {
        m[i] = v.x.size() >= 16 ? v.x[i] : (i % 5 == 0 ? v.f() : 0.0);
    }
    return m;
}

Matrix16 multiply(const Matrix16& a, const Matrix16& b) {
    Matrix16 r{};
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
            for (std::size_t k = 0; k < 4; ++k) {
                r[4 * i + j] += a[4 * i + k] * b[4 * k + j];
            }
        }
    }
    return r;
}

// Gauss-Jordan with partial pivoting.
Matrix16 inverse(const Matrix16& m) {
    Matrix16 a = m;
    Matrix16 r{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    for (std::size_t col = 0; col < 4; ++col) {
        std::size_t pivot = col;
        for (std::size_t row = col + 1; row < 4; ++row) {
            pivot = std::abs(a[4 * row + col]) > std::abs(a[4 * pivot + col]) ? row : pivot;
        }
        const double p = a[4 * pivot + col];
        if (p == 0) {
            return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
        }
        for (std::size_t k = 0; k < 4; ++k) {
            std::swap(a[4 * col + k], a[4 * pivot + k]);
            std::swap(r[4 * col + k], r[4 * pivot + k]);
            a[4 * col + k] /= p;
            r[4 * col + k] /= p;
        }
        for (std::size_t row = 0; row < 4; ++row) {
            const double f = row == col ? 0 : a[4 * row + col];
            for (std::size_t k = 0; k < 4 && f != 0; ++k) {
                a[4 * row + k] -= f * a[4 * col + k];
                r[4 * row + k] -= f * r[4 * col + k];
            }
        }
    }
    return r;
}

Triple3 transform_by(Type kind, const Triple3& p, const Matrix16& m) {
    if (kind == Type::Normal) { // n' = n (M^-1)^T with the upper 3x3
        Matrix16 upper = m;
        for (const std::size_t i : {3U, 7U, 11U, 12U, 13U, 14U}) {
            upper[i] = 0;
        }
        upper[15] = 1;
        const Matrix16 inv = inverse(upper);
        return {p[0] * inv[0] + p[1] * inv[1] + p[2] * inv[2],
                p[0] * inv[4] + p[1] * inv[5] + p[2] * inv[6],
                p[0] * inv[8] + p[1] * inv[9] + p[2] * inv[10]};
    }
    Triple3 r{};
    for (std::size_t j = 0; j < 3; ++j) {
        r[j] =
            p[0] * m[j] + p[1] * m[4 + j] + p[2] * m[8 + j] + (kind == Type::Point ? m[12 + j] : 0);
    }
    const double w = p[0] * m[3] + p[1] * m[7] + p[2] * m[11] + m[15];
    return kind == Type::Point && w != 1 && w != 0 ? scale3(r, 1 / w) : r;
}

} // namespace slc
