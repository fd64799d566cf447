// SPDX-License-Identifier: Apache-2.0
// 4x4 transforms in double precision, stored as RIB lists them: row vectors, p' = p M, translation
// in row 3. The product reads destination-from-source: cam_from_object = cam_from_world *
// world_from_object, so that point(cam_from_world, P_world) lines up, although the row-vector
// matrices multiply the other way round. All composition is in double; only finished results are
// rounded to float (design.md, section 6).
#pragma once

#include "runtime/base/vec.h"

#include <optional>

namespace base {

struct Mat4 {
    double m[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};

    static Mat4 translate(const V3d& d);
    static Mat4 scale(const V3d& s);
    // Degrees; a zero axis gives the identity. reference/ri.md 8.2 (Rodrigues).
    static Mat4 rotate(double angle_deg, const V3d& axis);
    // Degrees; [RI 3.2] Skew: shears so that d1 turns by the angle towards d2. nullopt when
    // undefined.
    static std::optional<Mat4> skew(double angle_deg, const V3d& d1, const V3d& d2);
    static Mat4 from_rows(const float* rows16);

    friend bool operator==(const Mat4&, const Mat4&) = default;
};

// dst_from_mid * mid_from_src: applies the right operand first.
Mat4 operator*(const Mat4& dst_from_mid, const Mat4& mid_from_src);

// nullopt for a singular (or non-finite) matrix.
std::optional<Mat4> inverse(const Mat4& m);
double determinant(const Mat4& m);
// Determinant of the upper 3x3; negative means that the transform mirrors (flips handedness).
double determinant3(const Mat4& m);
bool is_affine(const Mat4& m);

// Homogeneous divide included.
V3d point(const Mat4& m, const V3d& p);
V3d vector(const Mat4& m, const V3d& v);
// n' = n (M^-1)^T on the upper 3x3. Takes the *inverse* transform: callers hold it anyway.
V3d normal_by_inverse(const Mat4& inv, const V3d& n);

} // namespace base
