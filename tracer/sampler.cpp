// SPDX-License-Identifier: Apache-2.0
#include "tracer/sampler.h"

#include "tracer/adaptive.h"
#include "tracer/progressive.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>
#include <numeric>
#include <string>

namespace trace {

namespace {

constexpr int max_per_pixel = 4096;
// Positions of all patterns together: small enough to stay in the second-level cache with their
// filter weights.
constexpr int pattern_budget = 4096;
constexpr int min_patterns = 16;
constexpr std::size_t max_patterns = pattern_budget;
constexpr float below_one = 0x1.fffffep-1f;

constexpr auto mix = PixelHash::mix;
constexpr std::uint32_t golden = 0x9e3779b9U;

// What a hash is for; different uses must not correlate.
enum class Use : std::uint32_t { Position, Time, Lens };

// Another hash of the same pixel.
std::uint32_t derived(std::uint32_t pixel_hash, Use use) {
    return mix(pixel_hash + golden * static_cast<std::uint32_t>(use));
}

std::uint32_t hash(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    return mix(a + golden * mix(b + 0x85ebca6bU * mix(c + 1)));
}

// The random numbers of one pattern of one table, in a fixed order.
class Random {
public:
    Random(std::size_t pattern, Use use)
        : key_(hash(static_cast<std::uint32_t>(pattern), static_cast<std::uint32_t>(use),
                    0x7061747eU)) {}
    float unit() { return static_cast<float>(next() >> 8) * 0x1p-24f; }
    // Uniform in 0 .. n-1 for n far below 2^32.
    std::uint32_t below(std::uint32_t n) {
        return static_cast<std::uint32_t>((std::uint64_t{next()} * n) >> 32);
    }

private:
    std::uint32_t next() { return hash(key_, counter_++, 0x6e657874U); }
    std::uint32_t key_, counter_ = 0;
};

std::vector<std::uint32_t> permutation(std::size_t n, Random& random) {
    std::vector<std::uint32_t> p(n);
    std::iota(p.begin(), p.end(), 0U);
    for (std::size_t i = n; i > 1; --i) {
        std::swap(p[i - 1], p[random.below(static_cast<std::uint32_t>(i))]);
    }
    return p;
}

// One coordinate of a cell: cell i of n, sub-cell k of m, jittered there; pulled to the cell's
// centre by 1 - jitter.
float cell_position(int i, int n, std::uint32_t k, int m, float xi, float jitter) {
    const double inside = (k + static_cast<double>(xi)) / m;
    const double pulled = 0.5 + static_cast<double>(jitter) * (inside - 0.5);
    return std::min(static_cast<float>((i + pulled) / n), below_one);
}

// Correlated multi-jittered points [Kensler13]: one point in each of nx*ny cells, one in each of
// nx*ny columns and rows. The sub-column depends on the cell's row only, and the other way round,
// which spreads neighbours.
void multi_jitter(int nx, int ny, float jitter, Random& random, std::span<float> x,
                  std::span<float> y) {
    const auto sub_x = permutation(static_cast<std::size_t>(ny), random);
    const auto sub_y = permutation(static_cast<std::size_t>(nx), random);
    for (int j = 0; j < ny; ++j) {
        for (int i = 0; i < nx; ++i) {
            const auto s = static_cast<std::size_t>(j * nx + i);
            x[s] =
                cell_position(i, nx, sub_x[static_cast<std::size_t>(j)], ny, random.unit(), jitter);
            y[s] =
                cell_position(j, ny, sub_y[static_cast<std::size_t>(i)], nx, random.unit(), jitter);
        }
    }
}

// One time in each of n equal parts of [open, close], in random order.
void stratified_times(float open, float close, Random& random, std::span<float> out) {
    const auto order = permutation(out.size(), random);
    for (std::size_t s = 0; s < out.size(); ++s) {
        const float t =
            (static_cast<float>(order[s]) + random.unit()) / static_cast<float>(out.size());
        out[s] = std::clamp(open + t * (close - open), open, close);
    }
}

// From the unit square to the unit disc, area preserving and continuous ([pbrt4] A.5.1).
void disc_point(double u, double v, float& x, float& y) {
    const double a = 2 * u - 1, b = 2 * v - 1;
    if (a == 0 && b == 0) {
        x = y = 0;
        return;
    }
    const bool wide = std::fabs(a) > std::fabs(b);
    const double r = wide ? a : b;
    const double angle = wide ? std::numbers::pi / 4 * (b / a)
                              : std::numbers::pi / 2 - std::numbers::pi / 4 * (a / b);
    x = static_cast<float>(r * std::cos(angle));
    y = static_cast<float>(r * std::sin(angle));
}

// Multi-jittered lens points in random order, so that they do not follow the position in the pixel.
void lens_points(const SamplerSettings& settings, Random& random, std::span<float> lens_x,
                 std::span<float> lens_y) {
    std::vector<float> u(lens_x.size()), v(lens_x.size());
    multi_jitter(settings.nx, settings.ny, 1, random, u, v);
    const auto order = permutation(u.size(), random);
    for (std::size_t s = 0; s < u.size(); ++s) {
        disc_point(static_cast<double>(u[order[s]]), static_cast<double>(v[order[s]]), lens_x[s],
                   lens_y[s]);
    }
}

float hider_jitter(const rib::Options& options) {
    const rib::Param* p = options.hider_params.find("jitter");
    if (p == nullptr) {
        return 1;
    }
    const float value = !p->floats.empty() ? p->floats[0]
                        : !p->ints.empty() ? static_cast<float>(p->ints[0])
                                           : 1.0f;
    return std::isfinite(value) ? std::clamp(value, 0.0f, 1.0f) : 1.0f;
}

} // namespace

SamplerSettings sampler_settings(const rib::Options& options, base::Diag& diag) {
    SamplerSettings s;
    s.nx = std::clamp(options.xsamples, 1, max_per_pixel);
    s.ny = std::clamp(options.ysamples, 1, max_per_pixel);
    while (s.nx * s.ny > max_per_pixel) {
        int& larger = s.nx > s.ny ? s.nx : s.ny;
        larger = (larger + 1) / 2;
    }
    if (s.nx < options.xsamples || s.ny < options.ysamples) {
        diag.report(base::Severity::Warning, base::Code::Limit, options.samples_pos,
                    "PixelSamples: at most " + std::to_string(max_per_pixel) +
                        " samples per pixel; using " + std::to_string(s.nx) + " " +
                        std::to_string(s.ny));
    }
    s.jitter = hider_jitter(options);
    s.shutter_open = options.shutter_open;
    s.shutter_close = std::max(options.shutter_open, options.shutter_close);
    s.wants_lens = options.fstop < rib::ri_infinity && options.focal_length > 0;
    const AdaptiveSettings adaptive = adaptive_settings(options, s.nx * s.ny);
    if (adaptive.is_on() && s.jitter == 1) { // a regular grid has no first few
        s.least = adaptive.least;
        s.nx = adaptive.most;
        s.ny = 1;
    }
    return s;
}

Sampler::Sampler(const SamplerSettings& settings)
    : settings_(settings), per_pixel_(settings.nx * settings.ny),
      moving_(settings.shutter_close > settings.shutter_open) {
    num_patterns_ = std::bit_floor(
        static_cast<std::size_t>(std::max(pattern_budget / per_pixel_, min_patterns)));
    pattern_mask_ = num_patterns_ - 1;
    const auto n = static_cast<std::size_t>(per_pixel_);
    x_.resize(num_patterns_ * n);
    y_.resize(num_patterns_ * n);
    time_.resize(moving_ ? num_patterns_ * n : 0);
    lens_x_.resize(settings.wants_lens ? num_patterns_ * n : 0);
    lens_y_.resize(lens_x_.size());
    for (std::size_t p = 0; p < num_patterns_; ++p) {
        if (settings.least > 0) {
            make_progressive(p);
        } else {
            make_stratified(p);
        }
    }
}

// Patterns of different seeds have different random numbers.
std::size_t Sampler::numbered(std::size_t pattern) const {
    return pattern + std::size_t{settings_.seed} * max_patterns;
}

void Sampler::make_stratified(std::size_t pattern) {
    const auto n = static_cast<std::size_t>(per_pixel_);
    const auto of_pattern = [&](std::vector<float>& table) {
        return std::span(table).subspan(pattern * n, n);
    };
    const std::size_t number = numbered(pattern);
    Random position(number, Use::Position), time(number, Use::Time), lens(number, Use::Lens);
    multi_jitter(settings_.nx, settings_.ny, settings_.jitter, position, of_pattern(x_),
                 of_pattern(y_));
    if (moving_) {
        stratified_times(settings_.shutter_open, settings_.shutter_close, time, of_pattern(time_));
    }
    if (settings_.wants_lens) {
        lens_points(settings_, lens, of_pattern(lens_x_), of_pattern(lens_y_));
    }
}

void Sampler::make_progressive(std::size_t pattern) {
    const auto seed = [&](Use use) {
        return hash(static_cast<std::uint32_t>(numbered(pattern)), static_cast<std::uint32_t>(use),
                    0x70726f67U);
    };
    const auto n = static_cast<std::uint32_t>(per_quarter());
    std::size_t at = pattern * static_cast<std::size_t>(per_pixel_);
    for (std::uint32_t quarter = 0; quarter < quarters; ++quarter) {
        for (std::uint32_t index = 0; index < n; ++index, ++at) {
            make_progressive_sample(index, quarter, at,
                                    [&](Use use) { return hash(seed(use), quarter, 0x71756172U); });
        }
    }
}

template <class Seed>
void Sampler::make_progressive_sample(std::uint32_t index, std::uint32_t quarter, std::size_t at,
                                      const Seed& seed) {
    const UnitPoint p = progressive_point(index, seed(Use::Position));
    x_[at] = std::min((static_cast<float>(quarter & 1U) + p.x) / 2, below_one);
    y_[at] = std::min((static_cast<float>(quarter >> 1) + p.y) / 2, below_one);
    if (moving_) {
        const float open = settings_.shutter_open, close = settings_.shutter_close;
        const float t = shuffled_point(index, seed(Use::Time)).x;
        time_[at] = std::clamp(open + t * (close - open), open, close);
    }
    if (settings_.wants_lens) {
        const UnitPoint lens = shuffled_point(index, seed(Use::Lens));
        disc_point(static_cast<double>(lens.x), static_cast<double>(lens.y), lens_x_[at],
                   lens_y_[at]);
    }
}

std::span<const float> Sampler::slice(const std::vector<float>& table, std::size_t pattern) const {
    const auto n = static_cast<std::size_t>(per_pixel_);
    return std::span(table).subspan(pattern * n, n);
}

std::span<const float> Sampler::pattern_x(std::size_t pattern) const {
    return slice(x_, pattern);
}
std::span<const float> Sampler::pattern_y(std::size_t pattern) const {
    return slice(y_, pattern);
}

namespace {

// A few values: cheaper than a call of memcpy.
template <class T> void copy_few(const T* from, std::size_t n, T* to) {
    std::size_t i = 0;
    for (; i + 4 <= n; i += 4) {
        std::memcpy(to + i, from + i, 4 * sizeof(T));
    }
    for (; i < n; ++i) {
        to[i] = from[i];
    }
}

} // namespace

void Sampler::fill_pixel(std::uint32_t h, const PixelSamples& wanted, std::size_t at,
                         SampleBlock& out) const {
    const std::size_t first = wanted.first, n = wanted.last - first;
    const auto copy = [&](const std::vector<float>& table, std::uint32_t of,
                          std::vector<float>& to) {
        copy_few(table.data() + pattern(of) * static_cast<std::size_t>(per_pixel_) + first, n,
                 to.data() + at);
    };
    copy(x_, h, out.x);
    copy(y_, h, out.y);
    if (moving_) {
        copy(time_, derived(h, Use::Time), out.time);
    }
    if (settings_.wants_lens) {
        const std::uint32_t lens = derived(h, Use::Lens);
        copy(lens_x_, lens, out.lens_x);
        copy(lens_y_, lens, out.lens_y);
    }
    for (std::size_t s = 0; s < n; ++s) {
        out.px[at + s] = wanted.px;
        out.py[at + s] = wanted.py;
        out.seed[at + s] = h + golden * static_cast<std::uint32_t>(first + s + 8);
    }
}

void Sampler::begin(std::size_t count, SampleBlock& out) const {
    out.count = count;
    const std::size_t padded = out.num_packets() * 8;
    out.px.resize(padded);
    out.py.resize(padded);
    out.x.resize(padded);
    out.y.resize(padded);
    out.time.resize(padded);
    out.seed.resize(padded);
    out.lens_x.resize(settings_.wants_lens ? padded : 0);
    out.lens_y.resize(out.lens_x.size());
    if (!moving_) {
        std::fill(out.time.begin(), out.time.end(), settings_.shutter_open);
    }
}

void Sampler::finish(SampleBlock& out) {
    for (std::uint32_t& seed : out.seed) {
        seed = mix(seed);
    }
    const auto pad = [&](auto& values) {
        if (!values.empty() && out.count > 0) {
            std::fill(values.begin() + static_cast<std::ptrdiff_t>(out.count), values.end(),
                      values[out.count - 1]);
        }
    };
    pad(out.px), pad(out.py), pad(out.x), pad(out.y), pad(out.time), pad(out.seed);
    pad(out.lens_x), pad(out.lens_y);
}

void Sampler::fill(const PixelRange& pixels, SampleBlock& out) const {
    const auto n = static_cast<std::size_t>(per_pixel_);
    begin(pixels.area() * n, out);
    std::size_t at = 0;
    for (int py = pixels.y0; py < pixels.y1; ++py) {
        const PixelHash row(py);
        for (int px = pixels.x0; px < pixels.x1; ++px, at += n) {
            fill_pixel(row(px), {px, py, 0, static_cast<std::uint16_t>(n)}, at, out);
        }
    }
    finish(out);
}

void Sampler::fill_firsts(const PixelRange& pixels, SampleBlock& out) const {
    const int each = settings_.least / quarters;
    begin(pixels.area() * static_cast<std::size_t>(settings_.least), out);
    std::size_t at = 0;
    for (int py = pixels.y0; py < pixels.y1; ++py) {
        const PixelHash row(py);
        for (int px = pixels.x0; px < pixels.x1; ++px) {
            for (int q = 0; q < quarters; ++q, at += static_cast<std::size_t>(each)) {
                const int first = q * per_quarter();
                fill_pixel(row(px),
                           {px, py, static_cast<std::uint16_t>(first),
                            static_cast<std::uint16_t>(first + each)},
                           at, out);
            }
        }
    }
    finish(out);
}

void Sampler::fill(std::span<const PixelSamples> wanted, SampleBlock& out) const {
    std::size_t count = 0;
    for (const PixelSamples& w : wanted) {
        count += static_cast<std::size_t>(w.last - w.first);
    }
    begin(count, out);
    std::size_t at = 0;
    for (const PixelSamples& w : wanted) {
        fill_pixel(PixelHash(w.py)(w.px), w, at, out);
        at += static_cast<std::size_t>(w.last - w.first);
    }
    finish(out);
}

} // namespace trace
