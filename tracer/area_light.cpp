// SPDX-License-Identifier: Apache-2.0
#include "tracer/area_light.h"

#include "tracer/light_run.h"
#include "tracer/sampler.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace trace {

namespace {

std::uint32_t reversed(std::uint32_t x) {
    x = ((x & 0x55555555U) << 1) | ((x >> 1) & 0x55555555U);
    x = ((x & 0x33333333U) << 2) | ((x >> 2) & 0x33333333U);
    x = ((x & 0x0f0f0f0fU) << 4) | ((x >> 4) & 0x0f0f0f0fU);
    return __builtin_bswap32(x);
}

// [Burley20], the hash of Laine and Karras: bits depend on lower bits only.
std::uint32_t scrambled(std::uint32_t bits_reversed, std::uint32_t seed) {
    std::uint32_t x = bits_reversed + seed;
    x ^= x * 0x6c50b47cU;
    x ^= x * 0xb82f1e52U;
    x ^= x * 0xc7afe638U;
    x ^= x * 0x8d22f6e6U;
    return reversed(x);
}

// Bit-reversed second coordinate of Sobol's sequence.
std::uint32_t second_reversed(std::uint32_t index) {
    std::uint32_t sum = 0;
    for (std::uint32_t direction = 0x80000000U; index != 0;
         index >>= 1, direction ^= direction >> 1) {
        sum ^= (index & 1U) != 0 ? direction : 0;
    }
    return reversed(sum);
}

float unit(std::uint32_t x) {
    return static_cast<float>(x >> 8) * 0x1p-24f;
}

std::uint32_t mix(std::uint32_t x) {
    return PixelHash::mix(x);
}

} // namespace

std::array<float, 2> light_pattern(std::uint32_t seed, std::uint32_t index) {
    return {unit(scrambled(index, mix(seed))),
            unit(scrambled(second_reversed(index), mix(seed + 0x9e3779b9U)))};
}

std::uint32_t light_seed(std::uint32_t point_seed, std::uint32_t light, const base::V3f& P) {
    std::uint32_t h = mix(point_seed ^ (light * 0x9e3779b1U + 0x7f4a7c15U));
    for (const float x : {P.x, P.y, P.z}) {
        h = mix(h + std::bit_cast<std::uint32_t>(x));
    }
    return h;
}

geo::AreaPoint place_on_light(const LightInfo& light, const base::V3f& P, std::uint32_t seed,
                              std::int32_t sample) {
    const auto [x, y] = light_pattern(seed, static_cast<std::uint32_t>(sample));
    const double u = static_cast<double>(x), v = static_cast<double>(y);
    const geo::AreaSet& set = *light.area;
    const base::V3d eye(P);
    const geo::AreaSet::View view = light.by_angle ? set.seen_from(eye) : geo::AreaSet::View{};
    const double share = 1.0 / light.num_samples;
    geo::AreaPoint place;
    if (sample >= light.num_samples) { // the hidden part
        if (view.hidden > 0 && mix(seed ^ 0x5bd1e995U) % hidden_every == 0) {
            place = set.by_hidden(eye, u, v);
            place.weight *= hidden_every;
        }
    } else {
        place = view.solid_angle > 0 ? set.by_angle(eye, u, v) : set.by_area(u, v);
        place.weight *= share;
    }
    if (!place.hit.valid()) {
        place = set.by_area(u, v);
        place.weight = 0;
    }
    return place;
}

base::V3f direction_in_cone(const base::V3f& axis, float angle, const std::array<float, 2>& at) {
    const float half = std::sin(0.5f * angle);
    const float drop = at[0] * 2 * half * half; // 1 - cos
    const float sine = std::sqrt(std::max(0.0f, drop * (2 - drop)));
    const float turn = 2 * std::numbers::pi_v<float> * at[1];
    const base::V3f other = std::fabs(axis.x) < 0.6f ? base::V3f(1, 0, 0) : base::V3f(0, 1, 0);
    const base::V3f side = base::normalize(base::cross(axis, other)), up = base::cross(axis, side);
    return axis * (1 - drop) + side * (sine * std::cos(turn)) + up * (sine * std::sin(turn));
}

// --- learning

namespace {

constexpr std::uint32_t num_probes = SL_LANES_MAX;
constexpr std::int32_t probe_samples = 64;

// Points before and behind the light, from a quarter of its size away to four times that.
void place_probes(const geo::World& world, const geo::AreaSet& set, float* P) {
    geo::Hit hits[num_probes];
    for (std::uint32_t i = 0; i < num_probes; ++i) {
        const auto [x, y] = light_pattern(0x51ed270bU, i);
        hits[i] = set.by_area(static_cast<double>(x), static_cast<double>(y)).hit;
    }
    static constexpr float zero[num_probes] = {};
    float N[3 * num_probes] = {};
    sl_points points = {};
    points.var[SL_VAR_P] = P;
    points.var[SL_VAR_Ng] = N;
    world.fill(hits, {zero, zero, zero, zero, zero, zero, {}}, 1ULL << SL_VAR_P | 1ULL << SL_VAR_Ng,
               num_probes, points, nullptr, nullptr);
    const auto size = static_cast<float>(std::sqrt(set.area()));
    for (std::uint32_t i = 0; i < num_probes; ++i) {
        const float side = i % 4 == 3 ? -1.0f : 1.0f;
        const float distance = side * size * std::exp2(static_cast<float>(i % 5) - 2);
        for (std::size_t k = 0; k < 3 * num_probes; k += num_probes) {
            P[k + i] += distance * N[k + i];
        }
    }
}

struct Estimate {
    double mean = 0, variance = 0; // of one sample, as if it were the whole light
};

// What the probes get when places are chosen this way.
std::array<Estimate, num_probes> probe(Execution& asker, rib::LightId id, LightInfo light,
                                       bool by_angle, const float* P) {
    light.by_angle = by_angle;
    light.num_samples = probe_samples;
    LightRun run;
    run.attach(asker, light, id);
    sl_light_query query = {};
    query.lanes = asker.lanes();
    std::array<Estimate, num_probes> estimates{};
    for (std::uint32_t first = 0; first < num_probes; first += query.lanes) {
        float points[3 * SL_LANES_MAX] = {};
        for (std::uint32_t k = 0; k < 3; ++k) {
            std::copy_n(P + k * num_probes + first, query.lanes, points + k * query.lanes);
        }
        query.first = first;
        query.mask = (1U << query.lanes) - 1;
        query.P = points;
        for (query.sample = 0; query.sample < probe_samples; ++query.sample) {
            const std::uint32_t lit = run.illuminate(query);
            const LightSample& sample = run.sample(query.sample);
            for (std::uint32_t lane = 0; lane < query.lanes; ++lane) {
                double value = 0;
                for (std::size_t k = 0; k < 3; ++k) {
                    value += static_cast<double>(sample.Cl[k * LightSample::lanes + lane]);
                }
                value *= (lit >> lane & 1U) != 0 ? probe_samples : 0;
                estimates[first + lane].mean += value / probe_samples;
                estimates[first + lane].variance += value * value / probe_samples;
            }
        }
    }
    for (Estimate& e : estimates) {
        e.variance = std::max(0.0, e.variance - e.mean * e.mean);
    }
    return estimates;
}

} // namespace

void learn_area(const FrameContext& frame, rib::LightId id, LightInfo& light) {
    if (light.area == nullptr) {
        return;
    }
    ThreadState thread;
    Execution asker(frame, *light.shader);
    asker.thread = &thread;
    float P[3 * num_probes] = {};
    place_probes(*frame.world, *light.area, P);
    const auto area = probe(asker, id, light, false, P), angle = probe(asker, id, light, true, P);
    double error_area = 0, error_angle = 0;
    bool agree = true; // what by_angle() cannot choose gives nothing
    for (std::size_t i = 0; i < num_probes; ++i) {
        const double mean = std::max(area[i].mean, angle[i].mean);
        if (mean > 0) {
            error_area += area[i].variance / (mean * mean);
            error_angle += angle[i].variance / (mean * mean);
            const double error = std::sqrt((area[i].variance + angle[i].variance) / probe_samples);
            agree = agree && std::fabs(area[i].mean - angle[i].mean) <= 0.02 * mean + 4 * error;
        }
    }
    constexpr double clearly = 0.8; // solid angles cost more to choose from
    light.by_angle =
        error_angle < clearly * error_area && (agree || light.area->num_elements() > 1);
}

} // namespace trace
