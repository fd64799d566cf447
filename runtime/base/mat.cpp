// SPDX-License-Identifier: Apache-2.0
#include "runtime/base/mat.h"

#include <cmath>
#include <numbers>

namespace base {

Mat4 Mat4::translate(const V3d& d) {
    Mat4 r;
    r.m[3][0] = d.x;
    r.m[3][1] = d.y;
    r.m[3][2] = d.z;
    return r;
}

Mat4 Mat4::scale(const V3d& s) {
    Mat4 r;
    r.m[0][0] = s.x;
    r.m[1][1] = s.y;
    r.m[2][2] = s.z;
    return r;
}

Mat4 Mat4::rotate(double angle_deg, const V3d& axis) {
    Mat4 r;
    const V3d a = normalize(axis);
    if (length(a) == 0) {
        return r;
    }
    const double theta = angle_deg * std::numbers::pi / 180;
    const double c = std::cos(theta), s = std::sin(theta), k = 1 - c;
    r.m[0][0] = c + a.x * a.x * k;
    r.m[0][1] = a.x * a.y * k + a.z * s;
    r.m[0][2] = a.x * a.z * k - a.y * s;
    r.m[1][0] = a.x * a.y * k - a.z * s;
    r.m[1][1] = c + a.y * a.y * k;
    r.m[1][2] = a.y * a.z * k + a.x * s;
    r.m[2][0] = a.x * a.z * k + a.y * s;
    r.m[2][1] = a.y * a.z * k - a.x * s;
    r.m[2][2] = c + a.z * a.z * k;
    return r;
}

std::optional<Mat4> Mat4::skew(double angle_deg, const V3d& d1, const V3d& d2) {
    const V3d n1 = normalize(d1), n2 = normalize(d2);
    const double theta = angle_deg * std::numbers::pi / 180;
    const double cos_phi = dot(n1, n2);
    const double sin2_phi = 1 - cos_phi * cos_phi;
    if (length(n1) == 0 || length(n2) == 0 || sin2_phi < 1e-12) {
        return std::nullopt;
    }
    const double phi = std::acos(cos_phi);
    const double sin_rest = std::sin(phi - theta);
    if (!(theta < phi && theta > phi - std::numbers::pi) || std::fabs(sin_rest) < 1e-12) {
        return std::nullopt;
    }
    const double kappa = std::sin(theta) / sin_rest;
    const V3d b = (n1 - n2 * cos_phi) / sin2_phi;
    Mat4 r;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            r.m[i][j] += kappa * b[i] * n2[j];
        }
    }
    return r;
}

Mat4 Mat4::from_rows(const float* rows16) {
    Mat4 r;
    for (int i = 0; i < 16; ++i) {
        r.m[i / 4][i % 4] = static_cast<double>(rows16[i]);
    }
    return r;
}

Mat4 operator*(const Mat4& dst_from_mid, const Mat4& mid_from_src) {
    Mat4 r;
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) {
            double sum = 0;
            for (int k = 0; k < 4; ++k) {
                sum += mid_from_src.m[i][k] * dst_from_mid.m[k][j];
            }
            r.m[i][j] = sum;
        }
    }
    return r;
}

// Gauss-Jordan with partial pivoting.
std::optional<Mat4> inverse(const Mat4& in) {
    Mat4 a = in, inv;
    for (int col = 0; col < 4; ++col) {
        int pivot = col;
        for (int row = col + 1; row < 4; ++row) {
            if (std::fabs(a.m[row][col]) > std::fabs(a.m[pivot][col])) {
                pivot = row;
            }
        }
        const double p = a.m[pivot][col];
        if (p == 0 || !std::isfinite(p)) {
            return std::nullopt;
        }
        for (int j = 0; j < 4; ++j) {
            std::swap(a.m[col][j], a.m[pivot][j]);
            std::swap(inv.m[col][j], inv.m[pivot][j]);
        }
        for (int j = 0; j < 4; ++j) {
            a.m[col][j] /= p;
            inv.m[col][j] /= p;
        }
        for (int row = 0; row < 4; ++row) {
            const double f = a.m[row][col];
            if (row == col || f == 0) {
                continue;
            }
            for (int j = 0; j < 4; ++j) {
                a.m[row][j] -= f * a.m[col][j];
                inv.m[row][j] -= f * inv.m[col][j];
            }
        }
    }
    for (const auto& row : inv.m) {
        for (const double x : row) {
            if (!std::isfinite(x)) {
                return std::nullopt;
            }
        }
    }
    return inv;
}

double determinant3(const Mat4& m) {
    const auto& a = m.m;
    return a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) -
           a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
           a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
}

double determinant(const Mat4& m) {
    double det = 0;
    for (int col = 0; col < 4; ++col) {
        Mat4 minor;
        for (int i = 1; i < 4; ++i) {
            for (int j = 0, k = 0; j < 4; ++j) {
                if (j != col) {
                    minor.m[i - 1][k++] = m.m[i][j];
                }
            }
        }
        det += (col % 2 == 0 ? 1 : -1) * m.m[0][col] * determinant3(minor);
    }
    return det;
}

bool is_affine(const Mat4& m) {
    return m.m[0][3] == 0 && m.m[1][3] == 0 && m.m[2][3] == 0 && m.m[3][3] == 1;
}

V3d point(const Mat4& t, const V3d& p) {
    const auto& m = t.m;
    const V3d r{p.x * m[0][0] + p.y * m[1][0] + p.z * m[2][0] + m[3][0],
                p.x * m[0][1] + p.y * m[1][1] + p.z * m[2][1] + m[3][1],
                p.x * m[0][2] + p.y * m[1][2] + p.z * m[2][2] + m[3][2]};
    const double w = p.x * m[0][3] + p.y * m[1][3] + p.z * m[2][3] + m[3][3];
    return w == 1 || w == 0 ? r : r / w;
}

V3d vector(const Mat4& t, const V3d& v) {
    const auto& m = t.m;
    return {v.x * m[0][0] + v.y * m[1][0] + v.z * m[2][0],
            v.x * m[0][1] + v.y * m[1][1] + v.z * m[2][1],
            v.x * m[0][2] + v.y * m[1][2] + v.z * m[2][2]};
}

V3d normal_by_inverse(const Mat4& inv, const V3d& n) {
    const auto& m = inv.m;
    return {n.x * m[0][0] + n.y * m[0][1] + n.z * m[0][2],
            n.x * m[1][0] + n.y * m[1][1] + n.z * m[1][2],
            n.x * m[2][0] + n.y * m[2][1] + n.z * m[2][2]};
}

} // namespace base
