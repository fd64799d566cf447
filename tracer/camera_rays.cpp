// SPDX-License-Identifier: Apache-2.0
// Rays of the camera. Derived here (film-001): let M take camera to raster space, homogeneous row
// vectors. Points that share a raster position (X, Y) are (X, Y, s, 1) M^-1 for all s: a line
// through C = (0, 0, 1, 0) M^-1, the same point for every (X, Y). C.w != 0: C is the eye, and with
// A = (X, Y, 0, 1) M^-1 the direction A - A.w eye is affine in (X, Y) and leads to points of
// positive w. C.w = 0: C is the direction of all rays, and A lies on the ray.
#include "runtime/base/lanes4.h"
#include "tracer/camera.h"
#include "tracer/sampler.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace trace {

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

base::V3d row3(const base::Mat4& m, int row) {
    return {m.m[row][0], m.m[row][1], m.m[row][2]};
}

// Four doubles: a packet is two of these.
using Double4 [[gnu::vector_size(32)]] = double;
using base::Float4, base::Int4;

Double4 widened(const std::int32_t* from) {
    Int4 v;
    __builtin_memcpy(&v, from, sizeof v);
    return __builtin_convertvector(v, Double4);
}

Double4 widened(const float* from) {
    Float4 v;
    __builtin_memcpy(&v, from, sizeof v);
    return __builtin_convertvector(v, Double4);
}

void store(float* to, const Double4& v) {
    const Float4 rounded = __builtin_convertvector(v, Float4);
    __builtin_memcpy(to, &rounded, sizeof rounded);
}

} // namespace

bool Camera::init_rays(const base::Mat4& screen_from_camera) {
    const auto inverted = base::inverse(raster_from_screen_ * screen_from_camera);
    if (!inverted) {
        return false;
    }
    const base::Mat4& m = *inverted;
    const base::V3d through = row3(m, 2);
    const double w = m.m[2][3];
    simple_ = true;
    origin_w_ = {1, 0, 0};
    perspective_ = w != 0;
    if (perspective_) {
        const base::V3d eye = through / w;
        origin_ = {eye, {}, {}};
        direction_ = {row3(m, 3) - m.m[3][3] * eye, row3(m, 0) - m.m[0][3] * eye,
                      row3(m, 1) - m.m[1][3] * eye};
    } else {
        origin_ = {row3(m, 3), row3(m, 0), row3(m, 1)};
        direction_ = {through, {}, {}};
        origin_w_ = {m.m[3][3], m.m[0][3], m.m[1][3]};
        simple_ = origin_w_ == base::V3d{1, 0, 0};
    }
    normalise_depth();
    const double area = base::length(perspective_ ? direction_.vx : origin_.vx) *
                        base::length(perspective_ ? direction_.vy : origin_.vy);
    unit_per_px_ = static_cast<float>(std::sqrt(area));
    return true;
}

// Where the depth of directions (origins) does not depend on the raster position, t becomes camera
// z.
void Camera::normalise_depth() {
    const bool flat = direction_.vx.z == 0 && direction_.vy.z == 0 && direction_.v0.z > 0;
    if (flat) {
        const double scale = 1 / direction_.v0.z;
        direction_.v0 *= scale;
        direction_.vx *= scale;
        direction_.vy *= scale;
        direction_.v0.z = 1; // exactly
    }
    const bool level = origin_.vx.z == 0 && origin_.vy.z == 0;
    if (flat && level && !perspective_) {
        origin_.v0 = origin_.v0 - origin_.v0.z * direction_.v0; // start in the plane z = 0
    }
    simple_ = simple_ && flat && level && origin_.v0.z == 0;
}

Camera::Ray Camera::pinhole_ray(double x_px, double y_px) const {
    Ray ray;
    const double w = origin_w_.x + x_px * origin_w_.y + y_px * origin_w_.z;
    ray.origin = origin_.at(x_px, y_px) / w;
    ray.direction = direction_.at(x_px, y_px);
    clip(ray);
    return ray;
}

// [near, far] in camera z, then the user's planes.
void Camera::clip(Ray& ray) const {
    ray.tnear = perspective_ ? 0 : -inf;
    ray.tfar = inf;
    clip_half_space(ray, {{0, 0, -1}, -near_});
    if (far_ < inf) {
        clip_half_space(ray, {{0, 0, 1}, far_});
    }
    for (const Plane& plane : planes_) {
        clip_half_space(ray, plane);
    }
}

void Camera::clip_half_space(Ray& ray, const Plane& plane) const {
    const double slope = base::dot(plane.n, ray.direction);
    const double rest = plane.d - base::dot(plane.n, ray.origin); // t * slope <= rest is kept
    if (slope > 0) {
        ray.tfar = std::min(ray.tfar, rest / slope);
    } else if (slope < 0) {
        ray.tnear = std::max(ray.tnear, rest / slope);
    } else if (rest < 0) {
        ray.tfar = -inf;
    }
}

// Through a point of the lens and the point of the pinhole ray at the focal distance, ri.md 9.6.
Camera::Ray Camera::lens_ray(Ray ray, float lens_x, float lens_y) const {
    const base::V3d q{lens_radius_ * static_cast<double>(lens_x),
                      lens_radius_ * static_cast<double>(lens_y), 0};
    if (focal_distance_ < inf && ray.direction.z != 0) {
        const double t_focus = (focal_distance_ - ray.origin.z) / ray.direction.z;
        ray.direction = ray.direction - q / t_focus;
    }
    ray.origin += q;
    clip(ray);
    return ray;
}

// Rays that start in z = 0 with direction z = 1, so that t is camera z and Clipping needs no
// arithmetic. Perspective: the origins are equal and directions vary; otherwise the other way
// round.
void Camera::make_simple_packet(const SampleBlock& block, std::size_t first,
                                geo::RayPacket& out) const {
    constexpr int n = geo::RayPacket::size;
    const Affine& varying = perspective_ ? direction_ : origin_;
    const base::V3d& constant = perspective_ ? origin_.v0 : direction_.v0;
    float* const to_x = perspective_ ? out.dx : out.ox;
    float* const to_y = perspective_ ? out.dy : out.oy;
    for (std::size_t i = 0; i < n; i += 4) {
        const std::size_t s = first + i;
        const Double4 x = widened(block.px.data() + s) + widened(block.x.data() + s);
        const Double4 y = widened(block.py.data() + s) + widened(block.y.data() + s);
        store(to_x + i, varying.v0.x + x * varying.vx.x + y * varying.vy.x);
        store(to_y + i, varying.v0.y + x * varying.vx.y + y * varying.vy.y);
    }
    std::fill_n(perspective_ ? out.ox : out.dx, n, static_cast<float>(constant.x));
    std::fill_n(perspective_ ? out.oy : out.dy, n, static_cast<float>(constant.y));
    std::fill_n(out.oz, n, 0.0f);
    std::fill_n(out.dz, n, 1.0f);
    std::fill_n(out.tnear, n, static_cast<float>(near_));
    std::fill_n(out.tfar, n, static_cast<float>(far_));
    if (lens_radius_ > 0 && !block.lens_x.empty()) {
        add_lens(block, first, out);
    }
}

// Moves rays of z = 0 to the lens, through the same points at the focal distance, ri.md 9.6.
void Camera::add_lens(const SampleBlock& block, std::size_t first, geo::RayPacket& out) const {
    const float radius = static_cast<float>(lens_radius_);
    const float turn = static_cast<float>(lens_radius_ / focal_distance_); // 0: focus at infinity
    for (std::size_t i = 0; i < geo::RayPacket::size; ++i) {
        const float x = block.lens_x[first + i], y = block.lens_y[first + i];
        out.ox[i] += radius * x;
        out.oy[i] += radius * y;
        out.dx[i] -= turn * x;
        out.dy[i] -= turn * y;
    }
}

void Camera::make_general_packet(const SampleBlock& block, std::size_t first,
                                 geo::RayPacket& out) const {
    for (std::size_t i = 0; i < geo::RayPacket::size; ++i) {
        const std::size_t s = first + i;
        Ray ray = pinhole_ray(block.px[s] + static_cast<double>(block.x[s]),
                              block.py[s] + static_cast<double>(block.y[s]));
        if (lens_radius_ > 0 && !block.lens_x.empty()) {
            ray = lens_ray(ray, block.lens_x[s], block.lens_y[s]);
        }
        out.ox[i] = static_cast<float>(ray.origin.x);
        out.oy[i] = static_cast<float>(ray.origin.y);
        out.oz[i] = static_cast<float>(ray.origin.z);
        out.dx[i] = static_cast<float>(ray.direction.x);
        out.dy[i] = static_cast<float>(ray.direction.y);
        out.dz[i] = static_cast<float>(ray.direction.z);
        out.tnear[i] = static_cast<float>(ray.tnear);
        out.tfar[i] = static_cast<float>(ray.tfar);
        if (!(ray.tnear <= ray.tfar)) {
            out.active &= ~(1U << i);
        }
    }
}

void Camera::make_rays(const SampleBlock& block, std::span<geo::RayPacket> packets) const {
    for (std::size_t p = 0; p < block.num_packets(); ++p) {
        const std::size_t first = p * geo::RayPacket::size;
        const std::size_t live = std::min(block.count - first, std::size_t{geo::RayPacket::size});
        geo::RayPacket& out = packets[p];
        out.active = (1U << live) - 1U;
        std::copy_n(block.time.data() + first, geo::RayPacket::size, out.time);
        std::fill_n(out.mask, geo::RayPacket::size, std::uint32_t{geo::CameraRay});
        if (simple_) {
            make_simple_packet(block, first, out);
        } else {
            make_general_packet(block, first, out);
        }
    }
}

} // namespace trace
