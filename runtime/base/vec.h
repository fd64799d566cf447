// SPDX-License-Identifier: Apache-2.0
// Three-component value types shared by every module above the shader ABI.
// A Vec3 carries no space: variables say it with a suffix (P_cam, dir_object). Color is a separate
// type so that geometry and light cannot be mixed by accident.
#pragma once

#include <cmath>

namespace base {

template <class T> struct Vec3 {
    T x{}, y{}, z{};

    constexpr Vec3() = default;
    constexpr Vec3(T x_, T y_, T z_) : x(x_), y(y_), z(z_) {}
    constexpr explicit Vec3(T s) : x(s), y(s), z(s) {}
    template <class U>
    constexpr explicit Vec3(const Vec3<U>& o)
        : x(static_cast<T>(o.x)), y(static_cast<T>(o.y)), z(static_cast<T>(o.z)) {}

    constexpr T operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
    constexpr T& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }

    constexpr Vec3& operator+=(const Vec3& b) { return *this = *this + b; }
    constexpr Vec3& operator-=(const Vec3& b) { return *this = *this - b; }
    constexpr Vec3& operator*=(T s) { return *this = *this * s; }

    friend constexpr Vec3 operator+(const Vec3& a, const Vec3& b) {
        return {a.x + b.x, a.y + b.y, a.z + b.z};
    }
    friend constexpr Vec3 operator-(const Vec3& a, const Vec3& b) {
        return {a.x - b.x, a.y - b.y, a.z - b.z};
    }
    friend constexpr Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
    friend constexpr Vec3 operator*(const Vec3& a, T s) { return {a.x * s, a.y * s, a.z * s}; }
    friend constexpr Vec3 operator*(T s, const Vec3& a) { return a * s; }
    friend constexpr Vec3 operator/(const Vec3& a, T s) { return {a.x / s, a.y / s, a.z / s}; }
    friend constexpr bool operator==(const Vec3&, const Vec3&) = default;
};

using V3f = Vec3<float>;
using V3d = Vec3<double>;

template <class T> constexpr T dot(const Vec3<T>& a, const Vec3<T>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T> constexpr Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T> T length(const Vec3<T>& a) {
    return std::sqrt(dot(a, a));
}
// The zero vector stays zero, as the Shading Language's normalize() does.
template <class T> Vec3<T> normalize(const Vec3<T>& a) {
    const T len = length(a);
    return len > T(0) ? a / len : a;
}

// Linear RGB.
struct Color {
    float r = 0, g = 0, b = 0;

    constexpr Color() = default;
    constexpr explicit Color(float s) : r(s), g(s), b(s) {}
    constexpr Color(float r_, float g_, float b_) : r(r_), g(g_), b(b_) {}

    friend constexpr Color operator+(Color a, Color o) { return {a.r + o.r, a.g + o.g, a.b + o.b}; }
    friend constexpr Color operator-(Color a, Color o) { return {a.r - o.r, a.g - o.g, a.b - o.b}; }
    friend constexpr Color operator*(Color a, Color o) { return {a.r * o.r, a.g * o.g, a.b * o.b}; }
    friend constexpr Color operator*(Color a, float s) { return {a.r * s, a.g * s, a.b * s}; }
    constexpr Color& operator+=(Color o) { return *this = *this + o; }
    friend constexpr bool operator==(const Color&, const Color&) = default;
};

} // namespace base
