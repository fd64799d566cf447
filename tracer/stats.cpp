// SPDX-License-Identifier: Apache-2.0
#include "tracer/stats.h"

#include "runtime/abi/sl_abi.h"

#include <algorithm>
#include <cinttypes>
#include <cstdarg>
#include <cstdio>
#include <sys/resource.h>

namespace trace {

namespace {

struct Row {
    const char* id;
    const char* text;
};

constexpr Row counter_rows[] = {
#define TRACE_COUNTER(id, text) {#id, text},
#define TRACE_PHASE(id, text)
#include "tracer/stats.def"
#undef TRACE_COUNTER
#undef TRACE_PHASE
};

constexpr Row phase_rows[] = {
#define TRACE_COUNTER(id, text)
#define TRACE_PHASE(id, text) {#id, text},
#include "tracer/stats.def"
#undef TRACE_COUNTER
#undef TRACE_PHASE
};

__attribute__((format(printf, 2, 3))) void append(std::string& out, const char* format, ...) {
    char line[256];
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    out += line;
}

} // namespace

Counters& Counters::operator+=(const Counters& other) {
    for (std::size_t i = 0; i < value.size(); ++i) {
        value[i] += other.value[i];
    }
    return *this;
}

Stats& Stats::operator+=(const Stats& other) {
    counters += other.counters;
    for (std::size_t i = 0; i < seconds.size(); ++i) {
        seconds[i] += other.seconds[i];
    }
    world.shapes += other.world.shapes;
    world.triangles += other.world.triangles;
    world.quadrics += other.world.quadrics;
    world.grids += other.world.grids;
    world.instances += other.world.instances;
    world.bytes += other.world.bytes;
    world.build_seconds += other.world.build_seconds;
    return *this;
}

void Stats::subtract_frames_from_reading() {
    double& reading = seconds[static_cast<std::size_t>(Phase::read)];
    for (std::size_t i = 0; i < seconds.size(); ++i) {
        reading -= i == static_cast<std::size_t>(Phase::read) ? 0 : seconds[i];
    }
    reading = std::max(reading, 0.0);
}

double Stats::mean_live_lanes() const {
    const std::uint64_t offered = counters.get(Counter::lanes_offered);
    return offered == 0 ? 0
                        : static_cast<double>(SL_LANES_MAX) *
                              static_cast<double>(counters.get(Counter::lanes_live)) /
                              static_cast<double>(offered);
}

PhaseTimer::~PhaseTimer() {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
    stats_.seconds[static_cast<std::size_t>(phase_)] += elapsed.count();
}

std::uint64_t peak_memory_bytes() {
    rusage usage{};
    // Linux counts ru_maxrss in KiB.
    return getrusage(RUSAGE_SELF, &usage) == 0 ? static_cast<std::uint64_t>(usage.ru_maxrss) * 1024
                                               : 0;
}

std::string stats_text(const Stats& stats) {
    std::string out;
    for (std::size_t i = 0; i < stats.seconds.size(); ++i) {
        append(out, "%12.3f s  %s\n", stats.seconds[i], phase_rows[i].text);
    }
    for (std::size_t i = 0; i < stats.counters.value.size(); ++i) {
        append(out, "%14" PRIu64 "  %s\n", stats.counters.value[i], counter_rows[i].text);
    }
    append(out, "%14.2f  mean live lanes of %d\n", stats.mean_live_lanes(), SL_LANES_MAX);
    append(out,
           "%14" PRIu64 "  shapes (%" PRIu64 " triangles, %" PRIu64 " quadrics, %" PRIu64
           " grids, %" PRIu64 " instances)\n",
           stats.world.shapes, stats.world.triangles, stats.world.quadrics, stats.world.grids,
           stats.world.instances);
    append(out, "%14.1f  MB of geometry\n", static_cast<double>(stats.world.bytes) * 1e-6);
    append(out, "%14.1f  MB peak memory\n", static_cast<double>(peak_memory_bytes()) * 1e-6);
    return out;
}

std::string stats_json(const Stats& stats) {
    std::string out = "{\n  \"seconds\": {";
    for (std::size_t i = 0; i < stats.seconds.size(); ++i) {
        append(out, "%s\n    \"%s\": %.6f", i == 0 ? "" : ",", phase_rows[i].id, stats.seconds[i]);
    }
    out += "\n  },\n  \"counters\": {";
    for (std::size_t i = 0; i < stats.counters.value.size(); ++i) {
        append(out, "%s\n    \"%s\": %" PRIu64, i == 0 ? "" : ",", counter_rows[i].id,
               stats.counters.value[i]);
    }
    append(out, "\n  },\n  \"mean_live_lanes\": %.4f,\n", stats.mean_live_lanes());
    append(out,
           "  \"geometry\": {\"shapes\": %" PRIu64 ", \"triangles\": %" PRIu64
           ", \"quadrics\": %" PRIu64 ", \"grids\": %" PRIu64 ", \"instances\": %" PRIu64
           ", \"bytes\": %" PRIu64 ", \"build_seconds\": %.6f},\n",
           stats.world.shapes, stats.world.triangles, stats.world.quadrics, stats.world.grids,
           stats.world.instances, stats.world.bytes, stats.world.build_seconds);
    append(out, "  \"peak_memory_bytes\": %" PRIu64 "\n}\n", peak_memory_bytes());
    return out;
}

} // namespace trace
