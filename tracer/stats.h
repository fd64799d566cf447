// SPDX-License-Identifier: Apache-2.0
// Counters and times of a frame, declared by rows of stats.def. Each thread owns one Counters; they
// are added in slot order, so reports do not depend on which thread finished first (times of course
// do). Stats are what is reported; those of frames add up to those of the run.
#pragma once

#include "runtime/abi/sl_abi.h"
#include "runtime/base/ticks.h"

#include <array>
#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace trace {

enum class Phase : std::uint8_t {
#define TRACE_PHASE(id, text) id,
#include "tracer/stats.def"
    count
};
enum class Part : std::uint8_t {
#define TRACE_PART(id, text) id,
#include "tracer/stats.def"
    count
};
enum class Counter : std::uint8_t {
#define TRACE_COUNTER(id, rate, text) id,
#include "tracer/stats.def"
    count
};
enum class Amount : std::uint8_t {
#define TRACE_AMOUNT(id, merge, text) id,
#include "tracer/stats.def"
    count
};
enum class ShaderCount : std::uint8_t {
#define TRACE_SHADER(id, text) id,
#include "tracer/stats.def"
    count
};

// One value per row of a table.
template <class Row, class Value> struct PerRow {
    std::array<Value, static_cast<std::size_t>(Row::count)> values{};

    [[nodiscard]] Value& operator[](Row row) { return values[static_cast<std::size_t>(row)]; }
    [[nodiscard]] const Value& operator[](Row row) const {
        return values[static_cast<std::size_t>(row)];
    }
    PerRow& operator+=(const PerRow& other) {
        for (std::size_t i = 0; i < values.size(); ++i) {
            values[i] += other.values[i];
        }
        return *this;
    }
};

// How rows are called in reports.
struct RowText {
    std::string_view id, text;
    bool has_rate = false; // counters: also given per second
    bool is_max = false;   // amounts: the largest of several frames counts, not the sum
};
[[nodiscard]] std::span<const RowText> rows_of(Phase);
[[nodiscard]] std::span<const RowText> rows_of(Part);
[[nodiscard]] std::span<const RowText> rows_of(Counter);
[[nodiscard]] std::span<const RowText> rows_of(Amount);
[[nodiscard]] std::span<const RowText> rows_of(ShaderCount);

// What one thread counts about one shader. Where a clock for every run would cost too much (lights)
// some are timed and stand for all.
struct ShaderCounters {
    PerRow<ShaderCount, std::uint64_t> value;
    std::uint64_t ticks = 0, timed_batches = 0;

    void add_batch(std::uint64_t points, std::uint64_t packets, std::uint64_t lanes) {
        value[ShaderCount::points] += points;
        ++value[ShaderCount::batches];
        value[ShaderCount::packets] += packets;
        value[ShaderCount::lanes_offered] += packets * lanes;
        value[ShaderCount::lanes_live] += points;
    }
    void add_time(std::uint64_t elapsed_ticks) {
        ticks += elapsed_ticks;
        ++timed_batches;
    }
    ShaderCounters& operator+=(const ShaderCounters& other);
};

struct alignas(64) Counters {
    PerRow<Counter, std::uint64_t> value;
    PerRow<Part, std::uint64_t> ticks;
    std::vector<ShaderCounters> shaders; // by ShaderEntry::number
    std::uint64_t max_layers = 0;

    void add(Counter counter, std::uint64_t n = 1) { value[counter] += n; }
    [[nodiscard]] std::uint64_t get(Counter counter) const { return value[counter]; }
    [[nodiscard]] ShaderCounters& shader(std::uint32_t number) {
        if (number >= shaders.size()) {
            shaders.resize(std::size_t{number} + 1);
        }
        return shaders[number];
    }
    Counters& operator+=(const Counters& other);
};

// Adds the life time of the object to what a thread spent on a part.
class PartTimer {
public:
    PartTimer(Counters& counters, Part part)
        : ticks_(counters.ticks[part]), start_(base::ticks()) {}
    ~PartTimer() { ticks_ += base::ticks() - start_; }
    PartTimer(const PartTimer&) = delete;
    PartTimer& operator=(const PartTimer&) = delete;

private:
    std::uint64_t& ticks_;
    std::uint64_t start_;
};

// A shader that a frame uses, whatever its parameters.
struct ShaderName {
    std::string name, source; // as called; the .sl it was made from
    sl_shader_type type = SL_SHADER_surface;
    std::uint64_t num_instances = 0;
};

struct ShaderStats {
    ShaderName shader;
    PerRow<ShaderCount, std::uint64_t> value;
    double seconds = 0; // of all threads; lights run inside the surfaces that ask for them

    // Of 8, whatever width the shader was compiled for.
    [[nodiscard]] double mean_live_lanes() const;
};

struct Stats {
    PerRow<Counter, std::uint64_t> counters;
    PerRow<Phase, double> seconds;
    PerRow<Part, double> parts;
    PerRow<Amount, std::uint64_t> amounts;
    std::vector<ShaderStats> shaders;

    // What threads counted about shaders of this list.
    void add(const Counters& counted, std::span<const ShaderName> names, double seconds_per_tick);
    Stats& operator+=(const Stats& other);

    [[nodiscard]] double total_seconds() const;
    [[nodiscard]] double mean_live_lanes() const;
    // Events per second of the phase that makes them; 0 where nothing can be said.
    [[nodiscard]] double rate(Counter counter) const;
    // Of the threads' work on buckets and pictures, 0..1.
    [[nodiscard]] double share(const ShaderStats& shader) const;

private:
    [[nodiscard]] ShaderStats& shader(const ShaderName& name);
};

[[nodiscard]] std::string_view shader_type_name(sl_shader_type type);

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

} // namespace trace
