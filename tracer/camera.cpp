// SPDX-License-Identifier: Apache-2.0
// Spaces of the camera; rays are in camera_rays.cpp.
#include "tracer/camera.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

namespace trace {

namespace {

constexpr int max_resolution_px = 1 << 16;
constexpr double inf = std::numeric_limits<double>::infinity();

void report_range(base::Diag& diag, const std::string& text) {
    diag.report(base::Severity::Error, base::Code::Range, {}, text);
}

int checked_resolution(int resolution, int fallback, base::Diag& diag) {
    if (resolution > max_resolution_px) {
        report_range(diag, "Format: at most " + std::to_string(max_resolution_px) +
                               " pixels on a side; using that instead of " +
                               std::to_string(resolution));
        return max_resolution_px;
    }
    return resolution > 0 ? resolution : fallback;
}

bool positive(double x) {
    return x > 0 && std::isfinite(x);
}

// The part of the viewport the picture fills, ri.md 8.4; whole pixels, at least one.
PixelRange picture_range(const Raster& r, double frame_aspect) {
    const double viewport_aspect = r.xres * r.pixel_aspect / r.yres;
    double width = r.xres, height = r.yres;
    if (frame_aspect >= viewport_aspect) {
        height = r.yres * viewport_aspect / frame_aspect;
    } else {
        width = r.xres * frame_aspect / viewport_aspect;
    }
    return {0, 0, std::clamp(static_cast<int>(std::lround(width)), 1, r.xres),
            std::clamp(static_cast<int>(std::lround(height)), 1, r.yres)};
}

void default_screen(Raster& r, double f) {
    r.screen_right = f >= 1 ? f : 1;
    r.screen_top = f >= 1 ? 1 : 1 / f;
    r.screen_left = -r.screen_right;
    r.screen_bottom = -r.screen_top;
}

void set_screen(Raster& r, const rib::Options& options, double frame_aspect, base::Diag& diag) {
    default_screen(r, frame_aspect);
    if (!options.has_screen_window) {
        return;
    }
    const auto& w = options.screen_window;
    const double width = static_cast<double>(w[1]) - static_cast<double>(w[0]);
    const double height = static_cast<double>(w[3]) - static_cast<double>(w[2]);
    if (!positive(std::fabs(width)) || !positive(std::fabs(height))) {
        report_range(
            diag,
            "ScreenWindow: left and right, bottom and top must differ; using the default window");
        return;
    }
    r.screen_left = static_cast<double>(w[0]);
    r.screen_right = static_cast<double>(w[1]);
    r.screen_bottom = static_cast<double>(w[2]);
    r.screen_top = static_cast<double>(w[3]);
}

// Depth rows of the projections, ri.md 8.3. far may be infinite only for perspective.
base::Mat4 perspective_matrix(double tan_half_fov, double near, double far) {
    const double k = std::isinf(far) ? 1 : far / (far - near);
    base::Mat4 m;
    m.m[2][2] = tan_half_fov * k;
    m.m[2][3] = tan_half_fov;
    m.m[3][2] = -tan_half_fov * k * near;
    m.m[3][3] = 0;
    return m;
}

base::Mat4 orthographic_matrix(double near, double far) {
    base::Mat4 m;
    m.m[2][2] = 1 / (far - near);
    m.m[3][2] = -near / (far - near);
    return m;
}

// x' = sx x + ox, y' = sy y + oy.
base::Mat4 scale_offset(double sx, double ox, double sy, double oy) {
    base::Mat4 m;
    m.m[0][0] = sx;
    m.m[1][1] = sy;
    m.m[3][0] = ox;
    m.m[3][1] = oy;
    return m;
}

// Screen x, y and w do not depend on screen z: the usual transformations before Projection.
bool keeps_depth_apart(const base::Mat4& m) {
    return m.m[2][0] == 0 && m.m[2][1] == 0 && m.m[2][3] == 0;
}

} // namespace

CropSpan crop_span(int resolution_px, float min, float max) {
    // In float, as a fraction like 0.1 is meant: 640 * 0.1 is 64 there.
    const float res = static_cast<float>(resolution_px);
    const auto pixel = [&](double edge) {
        return static_cast<int>(std::clamp(std::ceil(edge), 0.0, resolution_px - 1.0));
    };
    const float first = res * min, last = res * max;
    return {pixel(static_cast<double>(first)), pixel(static_cast<double>(last) - 1) + 1};
}

Raster make_raster(const rib::Options& options, base::Diag& diag) {
    Raster r;
    r.xres = checked_resolution(options.xres, 640, diag);
    r.yres = checked_resolution(options.yres, 480, diag);
    r.pixel_aspect = positive(static_cast<double>(options.pixel_aspect))
                         ? static_cast<double>(options.pixel_aspect)
                         : 1;
    r.frame = {0, 0, r.xres, r.yres};
    const double viewport_aspect = r.xres * r.pixel_aspect / r.yres;
    const bool has_aspect = positive(static_cast<double>(options.frame_aspect));
    const double f = has_aspect ? static_cast<double>(options.frame_aspect) : viewport_aspect;
    r.picture = has_aspect ? picture_range(r, f) : r.frame;
    set_screen(r, options, f, diag);
    for (const float edge : options.crop) {
        if (!std::isfinite(edge)) {
            report_range(diag, "CropWindow: fractions must be numbers; rendering the whole frame");
            r.crop = r.frame;
            return r;
        }
    }
    const CropSpan x = crop_span(r.xres, options.crop[0], options.crop[1]);
    const CropSpan y = crop_span(r.yres, options.crop[2], options.crop[3]);
    r.crop = {x.begin, y.begin, x.end, y.end};
    return r;
}

Camera::Camera(const rib::Scene& scene, base::Diag& diag)
    : raster_(make_raster(scene.options, diag)),
      camera_from_world_(scene.camera_from_world.at(scene.options.shutter_open)) {
    const Raster& r = raster_;
    const double width = r.screen_right - r.screen_left, height = r.screen_top - r.screen_bottom;
    ndc_from_screen_ =
        scale_offset(1 / width, -r.screen_left / width, -1 / height, r.screen_top / height);
    raster_from_screen_ =
        base::Mat4::scale({double(r.picture.width()), double(r.picture.height()), 1}) *
        ndc_from_screen_;
    init_projection(scene, diag);
    init_lens(scene.options, diag);
    init_planes(scene.options);
}

void Camera::init_projection(const rib::Scene& scene, base::Diag& diag) {
    const rib::Options& o = scene.options;
    near_ = static_cast<double>(o.near_clip);
    far_ = o.far_clip >= rib::ri_infinity ? inf : static_cast<double>(o.far_clip);
    if (!(near_ > 0) || !(far_ > near_)) {
        report_range(diag, "Clipping: 0 < near < far is needed; clipping nothing");
        near_ = static_cast<double>(rib::ri_epsilon);
        far_ = inf;
    }
    const bool wants_perspective = o.projection == "perspective";
    const bool known = wants_perspective || o.projection == "orthographic" ||
                       o.projection == "null" || o.projection.empty();
    if (!known) {
        diag.report(
            base::Severity::Error, base::Code::Incapable, {},
            "Projection: \"" + o.projection +
                "\" is not known (perspective, orthographic, null are); using orthographic");
    }
    double fov_deg = static_cast<double>(o.fov_deg);
    if (wants_perspective && !(fov_deg > 0 && fov_deg < 180)) {
        report_range(diag, "Projection: fov must lie between 0 and 180 degrees; using 90");
        fov_deg = 90;
    }
    const double tan_half_fov = std::tan(fov_deg * std::numbers::pi / 360);
    // The orthographic limit for an infinite far plane would be singular; this is the same to float
    // precision.
    const double finite_far = std::isinf(far_) ? static_cast<double>(rib::ri_infinity) : far_;
    base::Mat4 projection; // the null projection: screen = camera
    base::Mat4 projection_for_rays;
    if (wants_perspective) {
        projection = perspective_matrix(tan_half_fov, near_, far_);
        projection_for_rays = perspective_matrix(tan_half_fov, 1, inf);
    } else if (o.projection != "null") {
        projection = orthographic_matrix(near_, finite_far);
    }
    base::Mat4 extra = scene.screen_from_camera_extra;
    if (!keeps_depth_apart(extra)) {
        projection_for_rays = projection;
    }
    if (!init_rays(extra * projection_for_rays)) {
        diag.report(base::Severity::Error, base::Code::Math, {},
                    "Projection: the transformation before it cannot be inverted; ignoring it");
        extra = {};
        (void)init_rays(wants_perspective ? perspective_matrix(tan_half_fov, 1, inf)
                                          : base::Mat4{});
    }
    screen_from_camera_ = extra * projection;
}

void Camera::init_lens(const rib::Options& o, base::Diag& diag) {
    if (o.fstop >= rib::ri_infinity || !(o.focal_length > 0)) {
        return;
    }
    if (!(o.fstop > 0) || !(o.focal_distance > 0)) {
        report_range(diag,
                     "DepthOfField: fstop and focaldistance must be positive; using a pinhole");
        return;
    }
    // Thin lens, ri.md 9.6.
    lens_radius_ = static_cast<double>(o.focal_length) / (2 * static_cast<double>(o.fstop));
    focal_distance_ =
        o.focal_distance >= rib::ri_infinity ? inf : static_cast<double>(o.focal_distance);
}

void Camera::init_planes(const rib::Options& o) {
    const auto world_from_camera = base::inverse(camera_from_world_);
    if (!world_from_camera) {
        return;
    }
    for (const auto& plane : o.clipping_planes) {
        const base::V3d p = base::point(
            camera_from_world_, {plane.point_world[0], plane.point_world[1], plane.point_world[2]});
        const base::V3d n = base::normal_by_inverse(
            *world_from_camera,
            {plane.normal_world[0], plane.normal_world[1], plane.normal_world[2]});
        planes_.push_back({n, base::dot(n, p)});
        simple_ = false;
    }
}

base::Mat4 Camera::ndc_from_camera() const {
    return ndc_from_screen_ * screen_from_camera_;
}
base::Mat4 Camera::raster_from_camera() const {
    return raster_from_screen_ * screen_from_camera_;
}
base::Mat4 Camera::ndc_from_world() const {
    return ndc_from_camera() * camera_from_world_;
}

base::Mat4 Camera::camera_from_raster() const {
    // Both factors were inverted when the camera was made.
    return base::inverse(raster_from_camera()).value_or(base::Mat4{});
}

namespace {

// Raster distance that a unit of camera space along axis covers at P = (0, 0, 1).
double pixels_per_unit(const base::Mat4& raster_from_camera, int axis) {
    const auto& m = raster_from_camera.m;
    const double w = m[2][3] + m[3][3];
    const double x = (m[2][0] + m[3][0]) / w, y = (m[2][1] + m[3][1]) / w;
    return std::hypot((m[axis][0] - x * m[axis][3]) / w, (m[axis][1] - y * m[axis][3]) / w);
}

} // namespace

geo::View Camera::view() const {
    const base::Mat4 m = raster_from_camera();
    geo::View view{.perspective = perspective_,
                   .pixels_per_unit_x = pixels_per_unit(m, 0),
                   .pixels_per_unit_y = pixels_per_unit(m, 1),
                   .near_clip = near_,
                   .corner_x = 0,
                   .corner_y = 0};
    for (const double x : {0, raster_.xres}) {
        for (const double y : {0, raster_.yres}) {
            const Ray ray = pinhole_ray(x, y);
            const base::V3d at = perspective_ ? ray.direction / ray.direction.z : ray.origin;
            view.corner_x = std::max(view.corner_x, std::fabs(at.x));
            view.corner_y = std::max(view.corner_y, std::fabs(at.y));
        }
    }
    return view;
}

float Camera::footprint(float z_cam, float spacing_px) const {
    return spacing_px * unit_per_px_ * (perspective_ ? z_cam : 1.0f);
}

float Camera::blur_px(float z_cam) const {
    const double z = static_cast<double>(z_cam);
    const double spread =
        perspective_ ? std::fabs(1 / z - 1 / focal_distance_) : std::fabs(1 - z / focal_distance_);
    return static_cast<float>(2 * lens_radius_ * spread / static_cast<double>(unit_per_px_));
}

} // namespace trace
