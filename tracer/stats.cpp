// SPDX-License-Identifier: Apache-2.0
#include "tracer/stats.h"

#include <algorithm>
#include <sys/resource.h>

namespace trace {

namespace {

constexpr bool RATE = true, PLAIN = false; // as the rows write it
constexpr bool MAX = true, SUM = false;

constexpr RowText phase_rows[] = {
#define TRACE_PHASE(id, text) {#id, text},
#include "tracer/stats.def"
};
constexpr RowText part_rows[] = {
#define TRACE_PART(id, text) {#id, text},
#include "tracer/stats.def"
};
constexpr RowText counter_rows[] = {
#define TRACE_COUNTER(id, rate, text) {#id, text, rate, false},
#include "tracer/stats.def"
};
constexpr RowText amount_rows[] = {
#define TRACE_AMOUNT(id, merge, text) {#id, text, false, merge},
#include "tracer/stats.def"
};
constexpr RowText shader_rows[] = {
#define TRACE_SHADER(id, text) {#id, text},
#include "tracer/stats.def"
};

double live_lanes(std::uint64_t live, std::uint64_t offered) {
    return offered == 0 ? 0
                        : static_cast<double>(SL_LANES_MAX) * static_cast<double>(live) /
                              static_cast<double>(offered);
}

} // namespace

std::span<const RowText> rows_of(Phase) {
    return phase_rows;
}
std::span<const RowText> rows_of(Part) {
    return part_rows;
}
std::span<const RowText> rows_of(Counter) {
    return counter_rows;
}
std::span<const RowText> rows_of(Amount) {
    return amount_rows;
}
std::span<const RowText> rows_of(ShaderCount) {
    return shader_rows;
}

// --- what threads count

ShaderCounters& ShaderCounters::operator+=(const ShaderCounters& other) {
    value += other.value;
    ticks += other.ticks;
    timed_batches += other.timed_batches;
    return *this;
}

Counters& Counters::operator+=(const Counters& other) {
    value += other.value;
    ticks += other.ticks;
    max_layers = std::max(max_layers, other.max_layers);
    shaders.resize(std::max(shaders.size(), other.shaders.size()));
    for (std::size_t i = 0; i < other.shaders.size(); ++i) {
        shaders[i] += other.shaders[i];
    }
    return *this;
}

// --- what is reported

double ShaderStats::mean_live_lanes() const {
    return live_lanes(value[ShaderCount::lanes_live], value[ShaderCount::lanes_offered]);
}

// Frames name their shaders in an order of their own; there are few.
ShaderStats& Stats::shader(const ShaderName& name) {
    const auto it = std::find_if(shaders.begin(), shaders.end(), [&](const ShaderStats& s) {
        return s.shader.type == name.type && s.shader.name == name.name &&
               s.shader.source == name.source;
    });
    if (it != shaders.end()) {
        return *it;
    }
    shaders.push_back({name, {}, 0});
    return shaders.back();
}

void Stats::add(const Counters& counted, std::span<const ShaderName> names,
                double seconds_per_tick) {
    counters += counted.value;
    for (std::size_t i = 0; i < parts.values.size(); ++i) {
        parts.values[i] += seconds_per_tick * static_cast<double>(counted.ticks.values[i]);
    }
    std::uint64_t& layers = amounts[Amount::max_layers];
    layers = std::max(layers, counted.max_layers);
    for (std::size_t i = 0; i < std::min(counted.shaders.size(), names.size()); ++i) {
        const ShaderCounters& from = counted.shaders[i];
        if (from.value[ShaderCount::batches] == 0) {
            continue;
        }
        ShaderStats& to = shader(names[i]);
        to.value += from.value;
        to.value[ShaderCount::instances] = names[i].num_instances;
        const auto timed = static_cast<double>(std::max<std::uint64_t>(from.timed_batches, 1));
        to.seconds += seconds_per_tick * static_cast<double>(from.ticks) *
                      static_cast<double>(from.value[ShaderCount::batches]) / timed;
    }
}

Stats& Stats::operator+=(const Stats& other) {
    counters += other.counters;
    seconds += other.seconds;
    parts += other.parts;
    for (std::size_t i = 0; i < amounts.values.size(); ++i) {
        std::uint64_t& to = amounts.values[i];
        const std::uint64_t from = other.amounts.values[i];
        to = amount_rows[i].is_max ? std::max(to, from) : to + from;
    }
    for (const ShaderStats& from : other.shaders) {
        ShaderStats& to = shader(from.shader);
        to.value += from.value;
        to.seconds += from.seconds;
    }
    return *this;
}

double Stats::total_seconds() const {
    double total = 0;
    for (const double s : seconds.values) {
        total += s;
    }
    return total;
}

double Stats::mean_live_lanes() const {
    return live_lanes(counters[Counter::lanes_live], counters[Counter::lanes_offered]);
}

double Stats::rate(Counter counter) const {
    const Phase phase = counter == Counter::points_imager ? Phase::write : Phase::render;
    return seconds[phase] > 0 ? static_cast<double>(counters[counter]) / seconds[phase] : 0;
}

double Stats::share(const ShaderStats& of) const {
    const double imaging = of.shader.type == SL_SHADER_imager ? of.seconds : 0;
    const double work =
        parts[Part::work_rays] + parts[Part::work_shade] + parts[Part::work_film] + imaging;
    return work > 0 ? of.seconds / work : 0;
}

std::string_view shader_type_name(sl_shader_type type) {
    switch (type) {
    case SL_SHADER_surface:
        return "surface";
    case SL_SHADER_displacement:
        return "displacement";
    case SL_SHADER_light:
        return "light";
    case SL_SHADER_volume:
        return "volume";
    case SL_SHADER_imager:
        return "imager";
    case SL_SHADER_transformation:
        return "transformation";
    }
    return "";
}

PhaseTimer::~PhaseTimer() {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
    stats_.seconds[phase_] += elapsed.count();
}

std::uint64_t peak_memory_bytes() {
    rusage usage{};
    // Linux counts ru_maxrss in KiB.
    return getrusage(RUSAGE_SELF, &usage) == 0 ? static_cast<std::uint64_t>(usage.ru_maxrss) * 1024
                                               : 0;
}

} // namespace trace
