// SPDX-License-Identifier: Apache-2.0
// The filter functions follow ri.md 9.3; where systems differ, film-004 says which way this one
// goes.
#include "tracer/filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace trace {

// Either separable, f(x, y) = axis(x, wx) axis(y, wy), or a function of the plane. Arguments are
// relative to the pixel centre and inside the widths.
struct FilterRow {
    std::string_view name;
    double (*axis)(double a, double w);
    double (*plane)(double x, double y, double wx, double wy);
};

namespace {

constexpr double pi = std::numbers::pi;
constexpr double max_width_px = 32;
constexpr int max_reach = 16; // of that width
constexpr std::size_t few_samples = 2;

// sin(pi a) / (pi a)
double sinc(double a) {
    return std::fabs(a) < 1e-9 ? 1 : std::sin(pi * a) / (pi * a);
}

double box(double, double) {
    return 1;
}

double triangle(double a, double w) {
    return 1 - std::fabs(a) / (w / 2);
}

double gaussian(double a, double w) {
    return std::exp(-2 * (2 * a / w) * (2 * a / w));
}

double catmull_rom_1d(double r) {
    r = std::fabs(r);
    if (r >= 2) {
        return 0;
    }
    return r < 1 ? (3 * r - 5) * r * r + 2 : ((-r + 5) * r - 8) * r + 4;
}

double catmull_rom(double x, double y, double, double) {
    return catmull_rom_1d(std::hypot(x, y));
}

double separable_catmull_rom(double a, double) {
    return catmull_rom_1d(a);
}

double windowed_sinc(double a, double w) {
    return std::cos(pi * a / (2 * w)) * sinc(a);
}

double lanczos(double a, double w) {
    return sinc(a) * sinc(2 * a / w);
}

double mitchell(double x, double w) {
    constexpr double B = 1.0 / 3, C = 1.0 / 3;
    const double a = std::fabs(4 * x / w);
    if (a > 2) {
        return 0;
    }
    return a <= 1
               ? ((12 - 9 * B - 6 * C) * a * a * a + (-18 + 12 * B + 6 * C) * a * a + 6 - 2 * B) / 6
               : ((-B - 6 * C) * a * a * a + (6 * B + 30 * C) * a * a + (-12 * B - 48 * C) * a +
                  8 * B + 24 * C) /
                     6;
}

// Square of the distance from the centre, 1 on the ellipse of the widths.
double ellipse(double x, double y, double wx, double wy) {
    const double X = 2 * x / wx, Y = 2 * y / wy;
    return X * X + Y * Y;
}

double disk(double x, double y, double wx, double wy) {
    return ellipse(x, y, wx, wy) < 1 ? 1 : 0;
}

// 2 J1(pi r) / (pi r), the transform of a disc, under a half cosine that ends on the ellipse.
double bessel(double x, double y, double wx, double wy) {
    const double e = ellipse(x, y, wx, wy);
    if (e >= 1) {
        return 0;
    }
    const double r = std::hypot(x, y);
    const double jinc = r < 1e-9 ? 1 : 2 * ::j1(pi * r) / (pi * r);
    return std::cos(pi / 2 * std::sqrt(e)) * jinc;
}

double blackman_harris(double a, double w) {
    const double t = 2 * pi * a / w;
    return 0.35875 + 0.48829 * std::cos(t) + 0.14128 * std::cos(2 * t) + 0.01168 * std::cos(3 * t);
}

constexpr FilterRow filters[] = {
    {"gaussian", gaussian, nullptr}, // first: the default
    {"box", box, nullptr},
    {"triangle", triangle, nullptr},
    {"catmull-rom", nullptr, catmull_rom},
    {"sinc", windowed_sinc, nullptr},
    {"mitchell", mitchell, nullptr},
    {"disk", nullptr, disk},
    {"bessel", nullptr, bessel},
    {"blackman-harris", blackman_harris, nullptr},
    {"lanczos", lanczos, nullptr},
    {"separable-catmull-rom", separable_catmull_rom, nullptr},
};

std::string known_filters() {
    std::string text;
    for (const FilterRow& row : filters) {
        text += (text.empty() ? "" : ", ") + std::string(row.name);
    }
    return text;
}

const FilterRow* find_filter(std::string_view name, base::Diag& diag, base::SourcePos pos) {
    for (const FilterRow& row : filters) {
        if (row.name == name) {
            return &row;
        }
    }
    diag.report(base::Severity::Error, base::Code::BadToken, pos,
                "PixelFilter: no filter is called \"" + std::string(name) +
                    "\"; using gaussian. Known: " + known_filters());
    return &filters[0];
}

double checked_width(float width, base::Diag& diag, base::SourcePos pos) {
    if (!(width > 0) || !std::isfinite(width)) {
        diag.report(base::Severity::Error, base::Code::Range, pos,
                    "PixelFilter: widths must be positive; using 2 instead of " +
                        std::to_string(width));
        return 2;
    }
    if (width > max_width_px) {
        diag.report(base::Severity::Warning, base::Code::Limit, pos,
                    "PixelFilter: width " + std::to_string(width) + " is limited to " +
                        std::to_string(static_cast<int>(max_width_px)) + " pixels");
        return max_width_px;
    }
    return static_cast<double>(width);
}

// Samples up to w/2 from the centre: that is ceil(w/2 - 1/2) pixels beyond the own one.
int reach(double width) {
    return std::max(0, static_cast<int>(std::ceil(width / 2 - 0.5)));
}

} // namespace

Filter::Filter(std::string_view name, float width_x_px, float width_y_px, base::Diag& diag,
               base::SourcePos pos)
    : row_(find_filter(name, diag, pos)), width_x_(checked_width(width_x_px, diag, pos)),
      width_y_(checked_width(width_y_px, diag, pos)) {}

std::string_view Filter::name() const {
    return row_->name;
}
int Filter::reach_x() const {
    return reach(width_x_);
}
int Filter::reach_y() const {
    return reach(width_y_);
}

double Filter::value(double x_px, double y_px) const {
    if (std::fabs(x_px) > width_x_ / 2 || std::fabs(y_px) > width_y_ / 2) {
        return 0;
    }
    return row_->plane != nullptr ? row_->plane(x_px, y_px, width_x_, width_y_)
                                  : row_->axis(x_px, width_x_) * row_->axis(y_px, width_y_);
}

bool Filter::axis_values(double x_px, double y_px, double& fx, double& fy) const {
    if (row_->axis == nullptr) {
        return false;
    }
    fx = std::fabs(x_px) > width_x_ / 2 ? 0 : row_->axis(x_px, width_x_);
    fy = std::fabs(y_px) > width_y_ / 2 ? 0 : row_->axis(y_px, width_y_);
    return true;
}

FilterWeights::FilterWeights(const Filter& filter, const Sampler& sampler)
    : reach_x_(filter.reach_x()), reach_y_(filter.reach_y()), per_pixel_(sampler.per_pixel()),
      floor_(1e-3f * static_cast<float>(std::fabs(filter.value(0, 0)))) {
    const auto n = static_cast<std::size_t>(per_pixel_);
    spans_.resize(sampler.num_patterns() * neighbours());
    weights_.resize(spans_.size() * n);
    for (std::size_t p = 0; p < sampler.num_patterns(); ++p) {
        for (std::size_t s = 0; s < n; ++s) {
            fill_sample(filter, static_cast<double>(sampler.pattern_x(p)[s]),
                        static_cast<double>(sampler.pattern_y(p)[s]),
                        weights_.data() + p * neighbours() * n + s);
        }
        for (std::size_t k = 0; k < neighbours(); ++k) {
            spans_[p * neighbours() + k] = used_span({weights(p * neighbours() + k), n});
        }
    }
}

// All weights of the sample at (x, y) in its pixel; out: one value every per_pixel floats.
void FilterWeights::fill_sample(const Filter& filter, double x, double y, float* out) const {
    double fx[max_reach * 2 + 1] = {}, fy[max_reach * 2 + 1] = {};
    const int reach = std::max(reach_x_, reach_y_);
    bool separable = true;
    for (int d = -reach; d <= reach && separable; ++d) {
        separable = filter.axis_values(d + x - 0.5, d + y - 0.5, fx[d + reach], fy[d + reach]);
    }
    for (int dy = -reach_y_; dy <= reach_y_; ++dy) {
        for (int dx = -reach_x_; dx <= reach_x_; ++dx, out += per_pixel_) {
            *out = static_cast<float>(separable ? fx[dx + reach] * fy[dy + reach]
                                                : filter.value(dx + x - 0.5, dy + y - 0.5));
        }
    }
}

FilterWeights::Span FilterWeights::used_span(std::span<const float> w) {
    // With few samples a branch that cannot be predicted costs more than multiplying by zero.
    if (w.size() <= few_samples) {
        return {0, static_cast<std::uint16_t>(w.size())};
    }
    const auto used = [](float x) { return x != 0; };
    const auto first = std::find_if(w.begin(), w.end(), used);
    const auto last = std::find_if(w.rbegin(), std::make_reverse_iterator(first), used).base();
    return {static_cast<std::uint16_t>(first - w.begin()),
            static_cast<std::uint16_t>(last - w.begin())};
}

} // namespace trace
