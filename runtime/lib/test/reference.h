// SPDX-License-Identifier: Apache-2.0
// The built-in functions over the real numbers, in a wide type: what values and differences are
// measured against. Written from reference/sl.md section 4 and the definition in
// runtime/lib/noise_lattice.h, independently of the bodies. In: arrays of arguments, component by
// component.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace lanes_test::reference {

template <class T> using Triple = std::array<T, 3>;

template <class T> T limit(T x, T lo, T hi) {
    return x < lo ? lo : hi < x ? hi : x;
}
template <class T> T mod(T a, T b) {
    return b == 0 ? T(0) : a - b * std::floor(a / b);
}
template <class T> T power(T x, T y) {
    if (y == 0)
        return 1;
    if (x == 0 || (x < 0 && y != std::floor(y)))
        return 0;
    return std::pow(x, y);
}
template <class T> T smoothstep(T lo, T hi, T x) {
    if (x < lo || hi <= x)
        return x < lo ? T(0) : T(1);
    const T t = (x - lo) / (hi - lo);
    return t * t * (3 - 2 * t);
}

// --- triples

template <class T> Triple<T> at(const T* x) {
    return {x[0], x[1], x[2]};
}
template <class T> T dot(const Triple<T>& a, const Triple<T>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class T> Triple<T> sum(const Triple<T>& a, const Triple<T>& b, T scale) {
    return {a[0] + scale * b[0], a[1] + scale * b[1], a[2] + scale * b[2]};
}
template <class T> Triple<T> cross(const Triple<T>& a, const Triple<T>& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
template <class T> T length(const Triple<T>& a) {
    return std::sqrt(dot(a, a));
}
template <class T> Triple<T> normalize(const Triple<T>& a) {
    const T l = length(a);
    return l == 0 ? a : Triple<T>{a[0] / l, a[1] / l, a[2] / l};
}
template <class T> void put(const Triple<T>& a, T* out) {
    std::copy(a.begin(), a.end(), out);
}

template <class T> T segment_distance(const Triple<T>& a, const Triple<T>& b, const Triple<T>& q) {
    const Triple<T> d = sum(b, a, T(-1)), e = sum(q, a, T(-1));
    const T dd = dot(d, d);
    const T t = dd == 0 ? T(0) : limit(dot(e, d) / dd, T(0), T(1));
    return length(sum(e, d, -t));
}
template <class T>
Triple<T> rotate(const Triple<T>& q, T angle, const Triple<T>& p0, const Triple<T>& p1) {
    const Triple<T> a = normalize(sum(p1, p0, T(-1))), d = sum(q, p0, T(-1));
    if (dot(a, a) == 0)
        return q;
    const T c = std::cos(angle), s = std::sin(angle);
    Triple<T> r = sum(p0, d, c);
    r = sum(r, cross(a, d), s);
    return sum(r, a, dot(a, d) * (1 - c));
}
template <class T> Triple<T> refract(const Triple<T>& i, const Triple<T>& n, T eta) {
    const T c = dot(i, n), k = 1 - eta * eta * (1 - c * c);
    if (k < 0)
        return {};
    return sum(sum(Triple<T>{}, i, eta), n, -(eta * c + std::sqrt(k)));
}
template <class T>
Triple<T> faceforward(const Triple<T>& n, const Triple<T>& i, const Triple<T>& ref) {
    const T sign = (dot(i, ref) <= 0 ? T(1) : T(-1)) * (dot(n, ref) >= 0 ? T(1) : T(-1));
    return {sign * n[0], sign * n[1], sign * n[2]};
}
// A point times a matrix of rows; homogeneous.
template <class T> Triple<T> transform(const T* m, const T* p) {
    T q[4];
    for (int j = 0; j < 4; j++)
        q[j] = p[0] * m[j] + p[1] * m[4 + j] + p[2] * m[8 + j] + m[12 + j];
    const T w = q[3] == 0 ? T(1) : q[3];
    return {q[0] / w, q[1] / w, q[2] / w};
}
template <class T> T determinant(const T* m) {
    T sum = 0;
    for (int j = 0; j < 4; j++) {
        Triple<T> row[3];
        for (int i = 0; i < 3; i++)
            for (int k = 0, to = 0; k < 4; k++)
                if (k != j)
                    row[i][static_cast<std::size_t>(to++)] = m[4 * (i + 1) + k];
        sum += (j % 2 ? -m[j] : m[j]) * dot(row[0], cross(row[1], row[2]));
    }
    return sum;
}

// --- splines: rows of a basis are the coefficients of t^3 t^2 t 1

struct Basis {
    int step;
    double m[4][4];
};
inline constexpr Basis catmull_rom = {
    1, {{-.5, 1.5, -1.5, .5}, {1, -2.5, 2, -.5}, {-.5, 0, .5, 0}, {0, 1, 0, 0}}};
inline constexpr Basis bspline = {
    1, {{-1. / 6, .5, -.5, 1. / 6}, {.5, -1, .5, 0}, {-.5, 0, .5, 0}, {1. / 6, 4. / 6, 1. / 6, 0}}};
inline constexpr Basis bezier = {3, {{-1, 3, -3, 1}, {3, -6, 3, 0}, {-3, 3, 0, 0}, {1, 0, 0, 0}}};
inline constexpr Basis hermite = {2, {{2, 1, -2, 1}, {-3, -2, 3, -1}, {0, 1, 0, 0}, {1, 0, 0, 0}}};
inline constexpr Basis linear = {1, {{0, 0, 0, 0}, {0, 0, 0, 0}, {0, -1, 1, 0}, {0, 1, 0, 0}}};

template <class T> T spline(const Basis& b, T value, const T* knots, int n, int stride = 1) {
    const int segments = (n - 4) / b.step + 1;
    const T x = limit(value, T(0), T(1)) * segments;
    const int s = std::min(static_cast<int>(x), segments - 1);
    const T t = x - s, powers[4] = {t * t * t, t * t, t, 1};
    T total = 0;
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 4; k++)
            total += powers[i] * static_cast<T>(b.m[i][k]) * knots[(s * b.step + k) * stride];
    return total;
}

// --- noise, corner by corner

inline bool bit(std::uint32_t h, int n) {
    return h >> n & 1;
}

template <class T> T gradient(std::uint32_t h, int dims, const T* d) {
    const auto sign = [h](int n, T v) { return bit(h, n) ? -v : v; };
    switch (dims) {
    case 1:
        return sign(31, (1 + static_cast<T>(h >> 28 & 7)) * d[0]);
    case 2: {
        const T u = bit(h, 31) ? d[1] : d[0], v = bit(h, 31) ? d[0] : d[1];
        return sign(30, u) + 2 * sign(29, v);
    }
    case 3: {
        // The vectors are floats in the definition.
        const T g = static_cast<T>(0.997497f), a = sign(28, static_cast<T>(0.822598f));
        const T b = static_cast<T>(1.150362f), e = static_cast<T>(0.1f);
        const T along = bit(h, 30)   ? sign(29, g) * d[0] + sign(28, g) * d[1] + e * d[2]
                        : bit(h, 29) ? a * d[1] + b * d[2]
                                     : a * d[0] + b * d[2];
        return sign(31, along);
    }
    default: {
        const T u = bit(h, 31) && bit(h, 30) ? d[1] : d[0], v = bit(h, 31) ? d[2] : d[1];
        const T w = bit(h, 31) || bit(h, 30) ? d[3] : d[2];
        return sign(29, u) + sign(28, v) + sign(27, w);
    }
    }
}

// period nullptr: not periodic
template <class T> T noise(int dims, int channel, const T* a, const T* period = nullptr) {
    constexpr std::uint32_t primes[4] = {0x8da6b343, 0xb5297a4d, 0xcb1ab31f, 0xa7d69b35};
    constexpr std::uint32_t multipliers[3] = {0xe3779b97, 0x9d2c5681, 0x2c1b3c6d};
    constexpr float scale[5] = {0, 0.094f, 0.2535f, 0.468f, 0.435f};
    T total = 0;
    for (int corner = 0; corner < 1 << dims; corner++) {
        std::uint32_t h = 0;
        T d[4], weight = 1;
        for (int k = 0; k < dims; k++) {
            const int up = corner >> k & 1;
            const T whole = std::floor(a[k]), f = a[k] - whole;
            T index = whole + up;
            if (period) {
                const T p = limit(std::floor(period[k] + T(0.5)), T(1), T(8388608));
                index -= p * std::floor(index / p);
            }
            const auto term =
                static_cast<std::uint32_t>(static_cast<std::int64_t>(index)) * primes[k];
            h ^= k == 0 ? term + 0x9e3779b9u * static_cast<std::uint32_t>(dims) : term;
            d[k] = f - up;
            const T w = f * f * f * (f * (6 * f - 15) + 10);
            weight *= up ? w : 1 - w;
        }
        total += weight * gradient(h * multipliers[channel], dims, d);
    }
    const T value = T(0.5) + static_cast<T>(scale[dims]) * total;
    return dims == 4 ? limit(value, T(0), T(1)) : value;
}

template <class T> T cellnoise(int dims, int channel, const T* a) {
    constexpr std::uint32_t primes[4] = {0x8da6b343, 0xb5297a4d, 0xcb1ab31f, 0xa7d69b35};
    std::uint32_t h = 0;
    for (int k = 0; k < dims; k++) {
        const auto cell = static_cast<std::uint32_t>(static_cast<std::int64_t>(std::floor(a[k])));
        h ^= cell * primes[k] + (k == 0 ? 0x7f4a7c15u * static_cast<std::uint32_t>(dims) : 0);
    }
    h += channel == 0 ? 0 : channel == 1 ? 0x9e3779b9u : 0x3c6ef372u;
    h ^= h >> 16;
    h *= 0x85ebca6bu;
    h ^= h >> 13;
    h *= 0xc2b2ae35u;
    h ^= h >> 16;
    return static_cast<T>(h >> 8) / 16777216;
}

// --- colour spaces, by the case tables of sl.md 4.4

template <class T> T hue(const Triple<T>& c) {
    const T most = std::max({c[0], c[1], c[2]}), range = most - std::min({c[0], c[1], c[2]});
    if (range <= 0)
        return 0;
    const T sixth = c[0] == most   ? (c[1] - c[2]) / range
                    : c[1] == most ? 2 + (c[2] - c[0]) / range
                                   : 4 + (c[0] - c[1]) / range;
    return sixth < 0 ? sixth / 6 + 1 : sixth / 6;
}
template <class T> Triple<T> rgb_to_hsv(const Triple<T>& c) {
    const T most = std::max({c[0], c[1], c[2]}), range = most - std::min({c[0], c[1], c[2]});
    return {hue(c), most == 0 ? T(0) : range / most, most};
}
template <class T> Triple<T> rgb_to_hsl(const Triple<T>& c) {
    const T most = std::max({c[0], c[1], c[2]}), least = std::min({c[0], c[1], c[2]});
    const T l = (most + least) / 2, d = l < T(0.5) ? most + least : 2 - most - least;
    return {hue(c), most == least || d == 0 ? T(0) : (most - least) / d, l};
}
template <class T> Triple<T> wheel(T h, T most, T least) {
    const T sixth = (h - std::floor(h)) * 6, part = sixth - std::floor(sixth);
    const T rise = least + (most - least) * part, fall = most - (most - least) * part;
    switch (static_cast<int>(sixth) % 6) {
    case 0:
        return {most, rise, least};
    case 1:
        return {fall, most, least};
    case 2:
        return {least, most, rise};
    case 3:
        return {least, fall, most};
    case 4:
        return {rise, least, most};
    default:
        return {most, least, fall};
    }
}
template <class T> Triple<T> hsv_to_rgb(const Triple<T>& c) {
    return wheel(c[0], c[2], c[2] * (1 - c[1]));
}
template <class T> Triple<T> hsl_to_rgb(const Triple<T>& c) {
    const T half = c[1] * std::min(c[2], 1 - c[2]);
    return wheel(c[0], c[2] + half, c[2] - half);
}
template <class T> Triple<T> by_rows(const Triple<T>& c, const double (&m)[9]) {
    Triple<T> r;
    for (std::size_t k = 0; k < 3; k++)
        r[k] = static_cast<T>(m[3 * k]) * c[0] + static_cast<T>(m[3 * k + 1]) * c[1] +
               static_cast<T>(m[3 * k + 2]) * c[2];
    return r;
}
inline constexpr double rgb_of_yiq[9] = {1, .956, .620, 1, -.272, -.647, 1, -1.108, 1.705};
inline constexpr double yiq_of_rgb[9] = {.299, .587, .114, .596, -.275, -.321, .212, -.523, .311};
inline constexpr double rgb_of_xyz[9] = {3.24079, -1.53715, -.498535, -.969256, 1.875992,
                                         .041556, .055648,  -.204043, 1.057311};
inline constexpr double xyz_of_rgb[9] = {0.412400320,  0.357533719, 0.180399450,
                                         0.212643845,  0.715135558, 0.0721568450,
                                         0.0193313368, 0.119191390, 0.950225838};
template <class T> Triple<T> xyy_to_rgb(const Triple<T>& c) {
    if (c[1] == 0)
        return {};
    const T k = c[2] / c[1];
    return by_rows(Triple<T>{c[0] * k, c[2], (1 - c[0] - c[1]) * k}, rgb_of_xyz);
}
template <class T> Triple<T> rgb_to_xyy(const Triple<T>& c) {
    const Triple<T> x = by_rows(c, xyz_of_rgb);
    const T total = x[0] + x[1] + x[2];
    return total == 0 ? Triple<T>{} : Triple<T>{x[0] / total, x[1] / total, x[1]};
}

} // namespace lanes_test::reference
