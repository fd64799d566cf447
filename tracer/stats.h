// SPDX-License-Identifier: Apache-2.0
// Counters and times of a run, declared by rows of stats.def. Each thread owns one Counters; they
// are added in slot order, so reports do not depend on which thread finished first (times of course
// do).
#pragma once

#include "geometry/world.h"

#include <array>
#include <chrono>
#include <cstdint>
#include <string>

namespace trace {

enum class Counter {
#define TRACE_COUNTER(id, text) id,
#define TRACE_PHASE(id, text)
#include "tracer/stats.def"
#undef TRACE_COUNTER
#undef TRACE_PHASE
    count
};

enum class Phase {
#define TRACE_COUNTER(id, text)
#define TRACE_PHASE(id, text) id,
#include "tracer/stats.def"
#undef TRACE_COUNTER
#undef TRACE_PHASE
    count
};

struct alignas(64) Counters {
    std::array<std::uint64_t, static_cast<std::size_t>(Counter::count)> value{};

    void add(Counter counter, std::uint64_t n = 1) {
        value[static_cast<std::size_t>(counter)] += n;
    }
    [[nodiscard]] std::uint64_t get(Counter counter) const {
        return value[static_cast<std::size_t>(counter)];
    }
    Counters& operator+=(const Counters& other);
};

struct Stats {
    Counters counters;
    std::array<double, static_cast<std::size_t>(Phase::count)> seconds{};
    geo::Stats world;

    Stats& operator+=(const Stats& other);
    // Worlds render while their file is read: takes the time of all other phases off the reading.
    void subtract_frames_from_reading();
    // Of 8, whatever width the shaders were compiled for.
    [[nodiscard]] double mean_live_lanes() const;
};

// Adds the life time of the object to a phase.
class PhaseTimer {
public:
    PhaseTimer(Stats& stats, Phase phase)
        : stats_(stats), phase_(phase), start_(std::chrono::steady_clock::now()) {}
    ~PhaseTimer();
    PhaseTimer(const PhaseTimer&) = delete;
    PhaseTimer& operator=(const PhaseTimer&) = delete;

private:
    Stats& stats_;
    Phase phase_;
    std::chrono::steady_clock::time_point start_;
};

// Largest resident size of the process so far, bytes; 0 where the system does not tell.
[[nodiscard]] std::uint64_t peak_memory_bytes();

[[nodiscard]] std::string stats_text(const Stats& stats);
[[nodiscard]] std::string stats_json(const Stats& stats);

} // namespace trace
