// SPDX-License-Identifier: Apache-2.0
#include "tracer/shadow_map.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace trace {

namespace {

constexpr int most_samples = 1024;
// Where the slope of the receiver is not known it counts as lying within this many texel widths.
constexpr double unknown_slope_texels = 2;
// The plane goes through points of the receiver: between them a curved one rises above it. One
// whose radius is at least this many texels does not shade itself.
constexpr double least_radius_texels = 16;
// Depths are floats, and so are the points that are compared.
constexpr double rounding = 4e-6;
// A receiver seen more edge-on than this tells no useful plane.
constexpr double least_area = 1e-3;

std::uint32_t mix(std::uint32_t x) { // [Mueller] lowbias32
    x ^= x >> 16;
    x *= 0x7feb352dU;
    x ^= x >> 15;
    x *= 0x846ca68bU;
    return x ^ x >> 16;
}

// A stream of numbers in [0,1) that depends on a place only.
class Jitter {
public:
    Jitter(double x, double y)
        : seed_(mix(std::bit_cast<std::uint32_t>(static_cast<float>(x)) ^
                    mix(std::bit_cast<std::uint32_t>(static_cast<float>(y)) + 0x9e3779b9U))) {}
    [[nodiscard]] double next() {
        seed_ += 0x9e3779b9U;
        return mix(seed_) * (1.0 / 4294967296.0);
    }

private:
    std::uint32_t seed_;
};

} // namespace

// What one lookup compares: a parallelogram, widened by a box, in texels.
struct ShadowMap::Footprint {
    Spot at;
    double u[2] = {0, 0}, v[2] = {0, 0}; // full sides
    double box[2] = {0, 0};              // full width
    double slope[2] = {0, 0};            // of the key, per texel
    bool has_plane = false;
    double bias[2] = {0, 0};
    double tolerance = 0, key_tolerance = 0; // of depths, of keys
};

ShadowMap::ShadowMap(const MapImage& image)
    : width_(image.width), height_(image.height),
      camera_from_world_(base::Mat4::from_rows(image.camera_from_world)),
      screen_from_world_(base::Mat4::from_rows(image.screen_from_world)) {
    const auto n = static_cast<std::size_t>(image.num_channels);
    depth_.resize(image.values.size() / n);
    for (std::size_t i = 0; i < depth_.size(); ++i) {
        depth_[i] = image.values[i * n];
    }
    const base::Mat4 world_from_camera = base::inverse(camera_from_world_).value_or(base::Mat4{});
    const base::Mat4 screen_from_camera = screen_from_world_ * world_from_camera;
    perspective_ =
        std::abs(screen_from_camera.m[2][3]) > 1e-9 * std::abs(screen_from_camera.m[0][0]);
    // The screen is two wide.
    const double scale = std::hypot(screen_from_camera.m[0][0], screen_from_camera.m[1][0]) /
                         (perspective_ ? std::abs(screen_from_camera.m[2][3])
                                       : std::abs(screen_from_camera.m[3][3]));
    texel_ = scale > 0 ? 2 / (scale * width_) : 0;
}

ShadowMap::View ShadowMap::view(const base::Mat4& world_from_current) const {
    View v{camera_from_world_ * world_from_current, screen_from_world_ * world_from_current, {}};
    const base::Mat4 current_from_camera =
        base::inverse(v.camera_from_current).value_or(base::Mat4{});
    v.light = perspective_ ? base::point(current_from_camera, {0, 0, 0})
                           : base::normalize(base::vector(current_from_camera, {0, 0, -1}));
    return v;
}

base::V3d ShadowMap::to_light(const View& view, const base::V3d& P) const {
    return perspective_ ? base::normalize(view.light - P) : view.light;
}

ShadowMap::Spot ShadowMap::project(const View& view, const base::V3d& P) const {
    const auto& m = view.screen_from_current.m;
    const double w = P.x * m[0][3] + P.y * m[1][3] + P.z * m[2][3] + m[3][3];
    const double x = P.x * m[0][0] + P.y * m[1][0] + P.z * m[2][0] + m[3][0];
    const double y = P.x * m[0][1] + P.y * m[1][1] + P.z * m[2][1] + m[3][1];
    Spot spot;
    spot.z = base::point(view.camera_from_current, P).z;
    spot.ahead = spot.z > 0 && w > 0 && std::isfinite(x / w) && std::isfinite(y / w);
    if (spot.ahead) {
        spot.x = (0.5 + 0.5 * x / w) * width_;
        spot.y = (0.5 - 0.5 * y / w) * height_;
        spot.key = perspective_ ? 1 / spot.z : spot.z;
    }
    return spot;
}

ShadowMap::Footprint ShadowMap::footprint(const View& view, const Spot& at, const base::V3d& P,
                                          const base::V3d& P_u, const base::V3d& P_v,
                                          const ShadowOptions& options) const {
    Footprint f;
    f.at = at;
    const Spot u = project(view, P + P_u), v = project(view, P + P_v);
    const double du[3] = {u.x - at.x, u.y - at.y, u.key - at.key};
    const double dv[3] = {v.x - at.x, v.y - at.y, v.key - at.key};
    if (u.ahead && v.ahead) {
        const double area = du[0] * dv[1] - du[1] * dv[0];
        f.has_plane =
            std::abs(area) > least_area * std::hypot(du[0], du[1]) * std::hypot(dv[0], dv[1]);
        if (f.has_plane) {
            f.slope[0] = (du[2] * dv[1] - dv[2] * du[1]) / area;
            f.slope[1] = (dv[2] * du[0] - du[2] * dv[0]) / area;
        }
        const double size[2] = {static_cast<double>(width_), static_cast<double>(height_)};
        for (int k = 0; k < 2; ++k) {
            f.u[k] = std::clamp(du[k] * options.width[k], -size[k], size[k]);
            f.v[k] = std::clamp(dv[k] * options.width[k], -size[k], size[k]);
        }
    }
    // A texel is the least that can be told apart.
    f.box[0] = std::clamp(options.blur[0], 0.0, 1.0) * width_ + 1;
    f.box[1] = std::clamp(options.blur[1], 0.0, 1.0) * height_ + 1;
    f.bias[0] = options.bias[0];
    f.bias[1] = options.bias[1];
    if (!options.has_bias) {
        const double texel = texel_ * (perspective_ ? at.z : 1);
        const double side = std::max(std::hypot(du[0], du[1]), std::hypot(dv[0], dv[1]));
        const double rise_texels =
            side * side / (8 * least_radius_texels); // of an arc over its chord
        f.tolerance =
            (f.has_plane ? std::min(rise_texels, unknown_slope_texels) : unknown_slope_texels) *
                texel +
            rounding * (at.z + texel_ * width_);
        // Samples lie anywhere within their texels.
        f.key_tolerance = 0.5 * (std::abs(f.slope[0]) + std::abs(f.slope[1]));
    }
    return f;
}

// Whether texel (x, y) holds something between the light and the receiver's plane.
bool ShadowMap::hides(const Footprint& f, long x, long y, double random) const {
    if (x < 0 || y < 0 || x >= width_ || y >= height_) {
        return false;
    }
    const double dx = static_cast<double>(x) + 0.5 - f.at.x;
    const double dy = static_cast<double>(y) + 0.5 - f.at.y;
    const double key = f.at.key + f.slope[0] * dx + f.slope[1] * dy;
    if (perspective_ && key <= 0) {
        return false; // beyond the horizon of the plane
    }
    const double nearest = perspective_ ? 1 / (key + f.key_tolerance) : key - f.key_tolerance;
    const double receiver = f.has_plane ? nearest : f.at.z;
    const double bias = f.bias[0] + (f.bias[1] - f.bias[0]) * random + f.tolerance;
    const std::size_t index = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                              static_cast<std::size_t>(x);
    return static_cast<double>(depth_[index]) < receiver - bias;
}

// A box of one texel covers four, each by the area it shares: no sampling needed.
double ShadowMap::few_texels(const Footprint& f) const {
    const double x = f.at.x - 0.5, y = f.at.y - 0.5;
    const double x0 = std::floor(x), y0 = std::floor(y);
    Jitter jitter(f.at.x, f.at.y);
    double sum = 0;
    for (int j = 0; j < 2; ++j) {
        for (int i = 0; i < 2; ++i) {
            const double weight =
                (i != 0 ? x - x0 : 1 - (x - x0)) * (j != 0 ? y - y0 : 1 - (y - y0));
            const bool dark =
                hides(f, static_cast<long>(x0) + i, static_cast<long>(y0) + j, jitter.next());
            sum += dark ? weight : 0;
        }
    }
    return sum;
}

// Stratified in the parallelogram and, with the strata in another order, in the box.
double ShadowMap::many_texels(const Footprint& f, int samples) const {
    const int n = static_cast<int>(std::ceil(std::sqrt(std::clamp(samples, 1, most_samples))));
    Jitter jitter(f.at.x, f.at.y);
    const auto stratum = [&](int i) { return (i + jitter.next()) / n - 0.5; };
    int dark = 0;
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
            const double a = stratum(i), b = stratum(j);
            const double c = stratum((i + j) % n), d = stratum((i + 2 * j + 1) % n);
            const double x = f.at.x + a * f.u[0] + b * f.v[0] + c * f.box[0];
            const double y = f.at.y + a * f.u[1] + b * f.v[1] + d * f.box[1];
            dark += hides(f, std::lround(std::floor(x)), std::lround(std::floor(y)), jitter.next())
                        ? 1
                        : 0;
        }
    }
    return static_cast<double>(dark) / (n * n);
}

double ShadowMap::shadow(const View& view, const base::V3d& P, const base::V3d& P_u,
                         const base::V3d& P_v, const ShadowOptions& options) const {
    const Spot at = project(view, P);
    if (!at.ahead) {
        return 0;
    }
    const Footprint f = footprint(view, at, P, P_u, P_v, options);
    const double reach_x = std::abs(f.u[0]) + std::abs(f.v[0]) + f.box[0];
    const double reach_y = std::abs(f.u[1]) + std::abs(f.v[1]) + f.box[1];
    if (at.x + reach_x < 0 || at.y + reach_y < 0 || at.x - reach_x > width_ ||
        at.y - reach_y > height_) {
        return 0;
    }
    return reach_x <= 2 && reach_y <= 2 ? few_texels(f) : many_texels(f, options.samples);
}

} // namespace trace
