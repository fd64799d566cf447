// SPDX-License-Identifier: Apache-2.0
// State: transformations, moving ones, named coordinate systems, handedness (ri.md 6.8, 8, 12.3).
#include "ribtools/state_impl.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rib {

namespace {

using base::Mat4;
using base::V3d;

bool is_finite(const Mat4& m) {
    for (const auto& matrix_row : m.m) {
        for (const double x : matrix_row) {
            if (!std::isfinite(x)) {
                return false;
            }
        }
    }
    return true;
}

std::vector<float> merged_times(const Transform& a, const Transform& b) {
    std::vector<float> times;
    for (const Transform* t : {&a, &b}) {
        if (t->moving()) {
            for (const Transform::Key& key : t->keys) {
                times.push_back(key.time);
            }
        }
    }
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
    return times;
}

Mat4 matrix_from(const std::vector<double>& rows) {
    Mat4 m;
    for (std::size_t i = 0; i < 16; ++i) {
        m.m[i / 4][i % 4] = rows[i];
    }
    return m;
}

// ri.md 8.3, near 1 and far infinite: the PRMan reading of Perspective.
Mat4 perspective(double fov_deg) {
    const double t = std::tan(fov_deg * std::numbers::pi / 360);
    Mat4 m;
    m.m[2][2] = t;
    m.m[2][3] = t;
    m.m[3][2] = -t;
    m.m[3][3] = 0;
    return m;
}

// Screen from camera of the finished options, ri.md 8.3.
Mat4 screen_from_camera(const Options& o) {
    const double n = static_cast<double>(o.near_clip), f = static_cast<double>(o.far_clip);
    Mat4 m;
    if (o.projection == "perspective") {
        const double t = std::tan(static_cast<double>(o.fov_deg) * std::numbers::pi / 360);
        const double depth_scale = f >= static_cast<double>(ri_infinity) ? 1 : f / (f - n);
        m.m[2][2] = t * depth_scale;
        m.m[2][3] = t;
        m.m[3][2] = -t * depth_scale * n;
        m.m[3][3] = 0;
    } else if (o.projection != "null") {
        m.m[2][2] = 1 / (f - n);
        m.m[3][2] = -n / (f - n);
    }
    return m;
}

// ri.md 8.4; NDC is raster scaled to the unit square.
Mat4 raster_from_screen(const Options& o, bool ndc) {
    const auto [l, r, b, t] = o.screen_window;
    const double viewport_aspect = o.xres * static_cast<double>(o.pixel_aspect) / o.yres;
    const double f = o.frame_aspect > 0 ? static_cast<double>(o.frame_aspect) : viewport_aspect;
    const double w = ndc                    ? 1
                     : f >= viewport_aspect ? o.xres
                                            : std::round(o.xres * f / viewport_aspect);
    const double h = ndc                    ? 1
                     : f >= viewport_aspect ? std::round(o.yres * viewport_aspect / f)
                                            : o.yres;
    const auto width = static_cast<double>(r - l), height = static_cast<double>(t - b);
    Mat4 m;
    m.m[0][0] = w / width;
    m.m[3][0] = -w * static_cast<double>(l) / width;
    m.m[1][1] = -h / height;
    m.m[3][1] = h * static_cast<double>(t) / height;
    return m;
}

// A rotation is cut into steps this small, so that linear interpolation between the keys stays
// within 0.1 % of the radius: 1 - cos(2.5 deg) = 0.00095.
constexpr double max_step_deg = 5;
constexpr int max_steps = 256;

} // namespace

Transform operator*(const Transform& dst_from_mid, const Transform& mid_from_src) {
    if (!dst_from_mid.moving() && !mid_from_src.moving()) {
        return {{{0, dst_from_mid.still() * mid_from_src.still()}}};
    }
    Transform product;
    product.keys.clear();
    for (const float time : merged_times(dst_from_mid, mid_from_src)) {
        product.keys.push_back({time, dst_from_mid.at(time) * mid_from_src.at(time)});
    }
    return product;
}

std::optional<Transform> inverse(const Transform& t) {
    Transform result;
    result.keys.clear();
    for (const Transform::Key& key : t.keys) {
        const std::optional<Mat4> m = base::inverse(key.m);
        if (!m) {
            return std::nullopt;
        }
        result.keys.push_back({key.time, *m});
    }
    return result;
}

// The matrix of a transformation request; reported and nullopt when it has none.
std::optional<Mat4> State::matrix_of(const Request& r) {
    switch (r.id) {
    case RequestId::Identity:
        return Mat4();
    case RequestId::Transform:
    case RequestId::ConcatTransform:
        return matrix_from(r.args[0].numbers);
    case RequestId::Translate:
        return Mat4::translate({r.number(0), r.number(1), r.number(2)});
    case RequestId::Scale:
        return Mat4::scale({r.number(0), r.number(1), r.number(2)});
    case RequestId::Perspective:
        if (!(r.number(0) > 0 && r.number(0) < 180)) {
            error(base::Code::Range, r, "the angle must lie between 0 and 180; ignored");
            return std::nullopt;
        }
        return perspective(r.number(0));
    case RequestId::Rotate: {
        const V3d axis{r.number(1), r.number(2), r.number(3)};
        if (base::length(axis) == 0) {
            error(base::Code::Math, r, "the axis has no length; ignored");
            return std::nullopt;
        }
        return Mat4::rotate(r.number(0), axis);
    }
    case RequestId::Skew: {
        const std::optional<Mat4> m =
            Mat4::skew(r.number(0), {r.number(1), r.number(2), r.number(3)},
                       {r.number(4), r.number(5), r.number(6)});
        if (!m) {
            error(base::Code::Math, r,
                  "no such skew: parallel axes or too large an angle; ignored");
        }
        return m;
    }
    default:
        return std::nullopt;
    }
}

void State::set_transform(Transform t, const Request& request) {
    for (const Transform::Key& key : t.keys) {
        if (!is_finite(key.m)) {
            error(base::Code::Math, request, "the transformation is not finite; ignored");
            return;
        }
    }
    if (base::determinant3(t.still()) == 0) {
        warn(base::Code::Math, request, "the transformation has no inverse");
    }
    transform_ = {std::move(t), none};
}

void State::transform(const Request& request) {
    const std::optional<Mat4> m = matrix_of(request);
    if (!m) {
        return;
    }
    const bool replaces = request.id == RequestId::Identity || request.id == RequestId::Transform;
    set_transform(replaces ? still_transform(*m) : transform_.value * still_transform(*m), request);
}

// One transformation with a sample per time. Rotations about one axis interpolate their angle, by
// way of extra keys; everything else interpolates matrices, which for Translate and Scale is the
// same as interpolating the arguments.
void State::move_transform(std::span<Request> samples, std::span<const float> times) {
    Transform moving;
    moving.keys.clear();
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const std::optional<Mat4> m = matrix_of(samples[i]);
        if (!m) {
            return;
        }
        const Request& r = samples[i];
        if (r.id == RequestId::Rotate && i > 0) {
            const Request& before = samples[i - 1];
            const V3d axis{r.number(1), r.number(2), r.number(3)};
            const V3d axis_before{before.number(1), before.number(2), before.number(3)};
            const double from_deg = before.number(0), turn_deg = r.number(0) - from_deg;
            const bool same_axis = axis == axis_before && std::isfinite(turn_deg);
            const double wanted = same_axis ? std::ceil(std::fabs(turn_deg) / max_step_deg) : 1;
            const int steps = static_cast<int>(std::clamp(wanted, 1.0, double{max_steps}));
            for (int step = 1; step < steps; ++step) {
                const float part = static_cast<float>(step) / static_cast<float>(steps);
                moving.keys.push_back({times[i - 1] + (times[i] - times[i - 1]) * part,
                                       Mat4::rotate(from_deg + turn_deg * step / steps, axis)});
            }
        }
        moving.keys.push_back({times[i], *m});
    }
    const bool replaces =
        samples[0].id == RequestId::Identity || samples[0].id == RequestId::Transform;
    set_transform(replaces ? moving : transform_.value * moving, samples[0]);
}

// What maps the current system to camera space, as far as it is known, for handedness: inside an
// object the place of its definition stands in for that of its instances, which replay the request.
Mat4 State::camera_from_current() const {
    const Mat4 current = transform_.value.still();
    const bool in_world = blocks_.inside(BlockKind::World);
    const Mat4 outer = in_world ? scene_->camera_from_world.still() : Mat4();
    return open_object_ ? outer * object_base_ * current : outer * current;
}

// A named system in the space transformations are relative to; nullopt if unknown or without an
// inverse.
std::optional<Transform> State::named_system(const std::string& name) const {
    if (const auto it = attributes_.value.scoped_systems.find(name);
        it != attributes_.value.scoped_systems.end()) {
        return scene_->transforms[it->second];
    }
    if (const auto it = scene_->coordinate_systems.find(name);
        it != scene_->coordinate_systems.end()) {
        return scene_->transforms[it->second];
    }
    const bool in_world = blocks_.inside(BlockKind::World);
    if (name == "world") {
        return Transform();
    }
    const std::optional<Transform> from_camera =
        in_world ? inverse(scene_->camera_from_world) : Transform();
    if (name == "camera" || !from_camera) {
        return from_camera;
    }
    const Options& o = in_world ? scene_->options : options_;
    Mat4 m = screen_from_camera_extra_ * screen_from_camera(o);
    if (name == "raster" || name == "NDC") {
        m = raster_from_screen(o, name == "NDC") * m;
    } else if (name != "screen") {
        return std::nullopt;
    }
    const std::optional<Mat4> camera_from_named = base::inverse(m);
    if (!camera_from_named) {
        return std::nullopt;
    }
    return *from_camera * still_transform(*camera_from_named);
}

void State::do_Identity(Request& request) {
    transform(request);
}
void State::do_Transform(Request& request) {
    transform(request);
}
void State::do_ConcatTransform(Request& request) {
    transform(request);
}
void State::do_Perspective(Request& request) {
    transform(request);
}
void State::do_Translate(Request& request) {
    transform(request);
}
void State::do_Rotate(Request& request) {
    transform(request);
}
void State::do_Scale(Request& request) {
    transform(request);
}
void State::do_Skew(Request& request) {
    transform(request);
}

void State::do_CoordinateSystem(Request& request) {
    scene_->coordinate_systems[request.string(0)] = freeze_transform();
}

void State::do_ScopedCoordinateSystem(Request& request) {
    const TransformId id = freeze_transform();
    edit_attributes().scoped_systems.edit()[request.string(0)] = id;
}

void State::do_CoordSysTransform(Request& request) {
    const std::optional<Transform> t = named_system(request.string(0));
    if (!t) {
        error(base::Code::BadToken, request,
              "coordinate system " + quoted(request.string(0)) +
                  " is not known or has no inverse; ignored");
        return;
    }
    set_transform(*t, request);
}

} // namespace rib
