// SPDX-License-Identifier: Apache-2.0
#include "tracer/cube_map.h"

#include <algorithm>
#include <cmath>

namespace trace {

namespace {

// More probes along a footprint than this cost more than they show; a longer one is widened.
constexpr int most_probes = 32;
constexpr int most_channels = 16;

constexpr CubeFace faces[num_cube_faces] = {
    {{1, 0, 0}, {0, 1, 0}, {0, 0, -1}}, {{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
    {{0, 1, 0}, {0, 0, -1}, {1, 0, 0}}, {{0, -1, 0}, {0, 0, 1}, {1, 0, 0}},
    {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}},  {{0, 0, -1}, {0, 1, 0}, {-1, 0, 0}},
};

int face_of(const base::V3d& R) {
    const double x = std::abs(R.x), y = std::abs(R.y), z = std::abs(R.z);
    if (x >= y && x >= z) {
        return R.x >= 0 ? 0 : 1;
    }
    if (y >= z) {
        return R.y >= 0 ? 2 : 3;
    }
    return R.z >= 0 ? 4 : 5;
}

// Texel coordinates on a face of n texels, rows from the top.
struct Place {
    double x, y;
};
Place place_on(int face, const base::V3d& R, int n) {
    const CubeFace& f = faces[face];
    const double along = base::dot(R, f.forward);
    const double a = base::dot(R, f.right) / along, b = base::dot(R, f.up) / along;
    return {(0.5 + 0.5 * a) * n, (0.5 - 0.5 * b) * n};
}

base::V3d direction_of(int face, double x, double y, int n) {
    const CubeFace& f = faces[face];
    return f.forward + (2 * x / n - 1) * f.right + (1 - 2 * y / n) * f.up;
}

} // namespace

const CubeFace& cube_face(int face) {
    return faces[face];
}

CubeCell cube_cell(int face) {
    return {face / 2, face % 2};
}

bool CubeMap::fits(const MapImage& image) {
    return image.width > 0 && image.width % 3 == 0 && image.height % 2 == 0 &&
           image.width / 3 == image.height / 2 && image.num_channels <= most_channels;
}

CubeMap::CubeMap(const MapImage& image) : num_channels_(image.num_channels) {
    Level top;
    top.n = image.width / 3;
    const auto n = static_cast<std::size_t>(top.n), c = static_cast<std::size_t>(num_channels_);
    top.values.resize(num_cube_faces * n * n * c);
    for (int face = 0; face < num_cube_faces; ++face) {
        const CubeCell cell = cube_cell(face);
        for (std::size_t y = 0; y < n; ++y) {
            const std::size_t from = ((static_cast<std::size_t>(cell.row) * n + y) * 3 * n +
                                      static_cast<std::size_t>(cell.column) * n) *
                                     c;
            const std::size_t to = (static_cast<std::size_t>(face) * n + y) * n * c;
            std::copy_n(image.values.begin() + static_cast<std::ptrdiff_t>(from), n * c,
                        top.values.begin() + static_cast<std::ptrdiff_t>(to));
        }
    }
    levels_.push_back(std::move(top));
    while (levels_.back().n > 1) {
        levels_.push_back(half(levels_.back()));
    }
}

// Means of four texels; of an odd number the last ones count twice.
CubeMap::Level CubeMap::half(const Level& level) const {
    Level next;
    next.n = (level.n + 1) / 2;
    const int c = num_channels_;
    next.values.resize(num_cube_faces * static_cast<std::size_t>(next.n) *
                       static_cast<std::size_t>(next.n) * static_cast<std::size_t>(c));
    std::size_t to = 0;
    for (int face = 0; face < num_cube_faces; ++face) {
        for (int y = 0; y < next.n; ++y) {
            for (int x = 0; x < next.n; ++x) {
                const int x1 = std::min(2 * x + 1, level.n - 1);
                const int y1 = std::min(2 * y + 1, level.n - 1);
                const float* t[4] = {texel(level, face, 2 * x, 2 * y),
                                     texel(level, face, x1, 2 * y), texel(level, face, 2 * x, y1),
                                     texel(level, face, x1, y1)};
                for (int k = 0; k < c; ++k) {
                    next.values[to++] = 0.25f * ((t[0][k] + t[1][k]) + (t[2][k] + t[3][k]));
                }
            }
        }
    }
    return next;
}

std::size_t CubeMap::bytes() const {
    std::size_t sum = 0;
    for (const Level& level : levels_) {
        sum += level.values.size() * sizeof(float);
    }
    return sum;
}

// Beyond the edges: the texel of the neighbour that is seen there.
const float* CubeMap::texel(const Level& level, int face, int x, int y) const {
    const int n = level.n;
    if (x < 0 || y < 0 || x >= n || y >= n) {
        const base::V3d R = direction_of(face, x + 0.5, y + 0.5, n);
        face = face_of(R);
        const Place p = place_on(face, R, n);
        x = std::clamp(static_cast<int>(p.x), 0, n - 1);
        y = std::clamp(static_cast<int>(p.y), 0, n - 1);
    }
    const std::size_t index = (static_cast<std::size_t>(face) * static_cast<std::size_t>(n) +
                               static_cast<std::size_t>(y)) *
                                  static_cast<std::size_t>(n) +
                              static_cast<std::size_t>(x);
    return level.values.data() + index * static_cast<std::size_t>(num_channels_);
}

void CubeMap::bilinear(const Level& level, const base::V3d& R, int channel, double weight,
                       std::span<double> sum) const {
    const int face = face_of(R);
    const Place p = place_on(face, R, level.n);
    const double x = p.x - 0.5, y = p.y - 0.5;
    const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
    const double fx = x - x0, fy = y - y0;
    const float* t[4] = {texel(level, face, x0, y0), texel(level, face, x0 + 1, y0),
                         texel(level, face, x0, y0 + 1), texel(level, face, x0 + 1, y0 + 1)};
    const double w[4] = {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy};
    for (std::size_t k = 0; k < sum.size(); ++k) {
        const std::size_t at = static_cast<std::size_t>(channel) + k;
        for (int i = 0; i < 4; ++i) {
            sum[k] += weight * w[i] * static_cast<double>(t[i][at]);
        }
    }
}

void CubeMap::trilinear(double lod, const base::V3d& R, int channel, double weight,
                        std::span<double> sum) const {
    const double last = static_cast<double>(levels_.size() - 1);
    lod = std::clamp(lod, 0.0, last);
    const auto low = static_cast<std::size_t>(lod);
    const double part = lod - static_cast<double>(low);
    bilinear(levels_[low], R, channel, weight * (1 - part), sum);
    if (part > 0) {
        bilinear(levels_[low + 1], R, channel, weight * part, sum);
    }
}

// The footprint on the plane that touches the sphere of directions at R: full axes.
struct CubeMap::Ellipse {
    base::V3d major;
    double major_length = 0, minor_length = 0;

    Ellipse(const base::V3d& unit, double length, const CubeFootprint& f) {
        const auto across = [&](const base::V3d& d) {
            const base::V3d a = (1 / length) * d;
            return a - base::dot(a, unit) * unit;
        };
        const base::V3d u = across(f.R_u), v = across(f.R_v);
        const double uu = base::dot(u, u), vv = base::dot(v, v), uv = base::dot(u, v);
        const double blur = f.blur_rad * f.blur_rad;
        const double mean = 0.5 * (uu + vv), spread = std::hypot(0.5 * (uu - vv), uv);
        // The axis turns (u, v) by half the angle whose tangent is 2 uv / (uu - vv).
        const double angle = 0.5 * std::atan2(2 * uv, uu - vv);
        const base::V3d axis = std::cos(angle) * u + std::sin(angle) * v;
        major_length = std::sqrt(mean + spread + blur);
        minor_length = std::sqrt(std::max(mean - spread, 0.0) + blur);
        const double axis_length = base::length(axis);
        major = axis_length > 0 ? (major_length / axis_length) * axis : base::V3d{0, 0, 0};
    }
};

void CubeMap::lookup(const base::V3d& R, const CubeFootprint& footprint, int channel,
                     std::span<float> out) const {
    const double length = base::length(R);
    double sum[most_channels] = {};
    if (length > 0 && std::isfinite(length)) {
        const base::V3d unit = (1 / length) * R;
        const Ellipse e(unit, length, footprint);
        const double texel = 2.0 / size();
        const double minor =
            std::max({e.minor_length, e.major_length / most_probes, texel}); // at least a texel
        const int probes =
            std::clamp(static_cast<int>(std::ceil(e.major_length / minor)), 1, most_probes);
        const double lod = std::log2(minor / texel);
        // Probes as wide as the minor axis cover the major one; a round footprint is one probe, and
        // nothing jumps on the way there.
        const double span = 1 - minor / std::max(e.major_length, minor);
        for (int i = 0; i < probes; ++i) {
            const double at = probes > 1 ? (static_cast<double>(i) / (probes - 1) - 0.5) * span : 0;
            trilinear(lod, unit + at * e.major, channel, 1.0 / probes, {sum, out.size()});
        }
    }
    std::copy_n(sum, out.size(), out.begin());
}

namespace {

// Bilinear; beyond the edge the last pixels.
void sample_picture(const MapImage& image, double x, double y, float* out) {
    const double px = std::clamp(x * image.width - 0.5, 0.0, image.width - 1.0);
    const double py = std::clamp(y * image.height - 0.5, 0.0, image.height - 1.0);
    const int x0 = static_cast<int>(px), y0 = static_cast<int>(py);
    const int x1 = std::min(x0 + 1, image.width - 1), y1 = std::min(y0 + 1, image.height - 1);
    const double fx = px - x0, fy = py - y0;
    const auto at = [&](int i, int j, int k) {
        const std::size_t pixel =
            static_cast<std::size_t>(j) * static_cast<std::size_t>(image.width) +
            static_cast<std::size_t>(i);
        return static_cast<double>(
            image.values[pixel * static_cast<std::size_t>(image.num_channels) +
                         static_cast<std::size_t>(k)]);
    };
    for (int k = 0; k < image.num_channels; ++k) {
        out[k] = static_cast<float>((1 - fy) * ((1 - fx) * at(x0, y0, k) + fx * at(x1, y0, k)) +
                                    fy * ((1 - fx) * at(x0, y1, k) + fx * at(x1, y1, k)));
    }
}

} // namespace

MapImage assemble_cube(std::span<const MapImage, num_cube_faces> pictures, double fov_deg) {
    constexpr double pi = 3.14159265358979323846;
    const double reach = std::tan(std::clamp(fov_deg, 90.0, 170.0) * pi / 360);
    int n = 1;
    for (const MapImage& p : pictures) {
        n = std::max(n, static_cast<int>(std::lround(p.width / reach)));
    }
    MapImage cube;
    cube.width = 3 * n;
    cube.height = 2 * n;
    cube.num_channels = pictures[0].num_channels;
    const auto c = static_cast<std::size_t>(cube.num_channels);
    cube.values.resize(std::size_t{6} * static_cast<std::size_t>(n) * static_cast<std::size_t>(n) *
                       c);
    for (int face = 0; face < num_cube_faces; ++face) {
        const MapImage& p = pictures[static_cast<std::size_t>(face)];
        const CubeCell cell = cube_cell(face);
        const double aspect = static_cast<double>(p.width) / p.height;
        for (int y = 0; y < n; ++y) {
            for (int x = 0; x < n; ++x) {
                const double a = (2 * (x + 0.5) / n - 1) / reach;
                const double b = (2 * (y + 0.5) / n - 1) / reach * aspect;
                const std::size_t pixel =
                    static_cast<std::size_t>(cell.row * n + y) * static_cast<std::size_t>(3 * n) +
                    static_cast<std::size_t>(cell.column * n + x);
                sample_picture(p, 0.5 + 0.5 * a, 0.5 + 0.5 * b, &cube.values[pixel * c]);
            }
        }
    }
    return cube;
}

} // namespace trace
