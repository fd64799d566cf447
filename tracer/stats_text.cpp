// SPDX-License-Identifier: Apache-2.0
// Statistics for people: aligned columns of plain text.
#include "tracer/run_record.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>

namespace trace {

namespace {

__attribute__((format(printf, 2, 3))) void append(std::string& out, const char* format, ...) {
    char line[512];
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    out += line;
}

// 1234567 as 1,234,567.
std::string grouped(std::uint64_t n) {
    std::string digits = std::to_string(n);
    for (std::size_t at = digits.size(); at > 3;) {
        at -= 3;
        digits.insert(at, ",");
    }
    return digits;
}

std::string per_second(double rate) {
    char text[32];
    if (rate >= 1e6) {
        std::snprintf(text, sizeof text, "%8.2f M/s", rate * 1e-6);
    } else {
        std::snprintf(text, sizeof text, "%8.1f k/s", rate * 1e-3);
    }
    return text;
}

// Names come from RIB files: one line, nothing a terminal obeys, and no longer than a column.
std::string printable(std::string_view name, std::size_t width) {
    std::string text;
    for (const char c : name.substr(0, width)) {
        text += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
    }
    return text;
}

void append_times(std::string& out, const Stats& stats) {
    for (std::size_t i = 0; i < stats.seconds.values.size(); ++i) {
        append(out, "%14.3f s  %s\n", stats.seconds.values[i], rows_of(Phase{})[i].text.data());
    }
    append(out, "%14.3f s  in all\n", stats.total_seconds());
}

void append_parts(std::string& out, const Stats& stats) {
    for (std::size_t i = 0; i < stats.parts.values.size(); ++i) {
        append(out, "%14.3f s  %s\n", stats.parts.values[i], rows_of(Part{})[i].text.data());
    }
}

void append_counters(std::string& out, const Stats& stats, bool all) {
    for (std::size_t i = 0; i < stats.counters.values.size(); ++i) {
        const RowText& row = rows_of(Counter{})[i];
        const std::uint64_t n = stats.counters.values[i];
        if (!row.has_rate && !all) {
            continue;
        }
        append(out, "%16s  %s", grouped(n).c_str(), row.text.data());
        if (row.has_rate && n > 0) {
            append(out, ", %s", per_second(stats.rate(static_cast<Counter>(i))).c_str());
        }
        out += '\n';
    }
    append(out, "%16.2f  mean live lanes of %d\n", stats.mean_live_lanes(), SL_LANES_MAX);
}

void append_amounts(std::string& out, const Stats& stats, bool all) {
    for (std::size_t i = 0; i < stats.amounts.values.size(); ++i) {
        const RowText& row = rows_of(Amount{})[i];
        constexpr std::string_view unit = "bytes ";
        if (row.text.starts_with(unit)) {
            append(out, "%13.1f MB  %s\n", static_cast<double>(stats.amounts.values[i]) * 1e-6,
                   row.text.substr(unit.size()).data());
        } else if (all) {
            append(out, "%16s  %s\n", grouped(stats.amounts.values[i]).c_str(), row.text.data());
        }
    }
}

void append_shaders(std::string& out, const Stats& stats) {
    std::vector<const ShaderStats*> order;
    for (const ShaderStats& s : stats.shaders) {
        order.push_back(&s);
    }
    std::stable_sort(order.begin(), order.end(), [](const ShaderStats* a, const ShaderStats* b) {
        return a->seconds > b->seconds;
    });
    append(out, "  %-24s %-8s %6s %14s %10s %11s %5s %9s %6s\n", "shader", "type", "sets", "points",
           "batches", "packets", "lanes", "seconds", "share");
    for (const ShaderStats* s : order) {
        const auto count = [&](ShaderCount row) { return grouped(s->value[row]); };
        append(out, "  %-24s %-8s %6s %14s %10s %11s %5.2f %9.3f %5.1f%%\n",
               printable(s->shader.name, 24).c_str(), shader_type_name(s->shader.type).data(),
               count(ShaderCount::instances).c_str(), count(ShaderCount::points).c_str(),
               count(ShaderCount::batches).c_str(), count(ShaderCount::packets).c_str(),
               s->mean_live_lanes(), s->seconds, 100 * stats.share(*s));
    }
}

} // namespace

std::string stats_text(const Stats& stats, StatsLevel level) {
    std::string out;
    if (level == StatsLevel::None) {
        return out;
    }
    const bool full = level == StatsLevel::Full;
    append_times(out, stats);
    if (full) {
        append_parts(out, stats);
    }
    append_counters(out, stats, full);
    append_amounts(out, stats, full);
    if (level >= StatsLevel::Shaders && !stats.shaders.empty()) {
        append_shaders(out, stats);
    }
    return out;
}

std::string FrameRecord::title() const {
    std::string text = is_numbered ? "frame " + std::to_string(number) : std::string("picture");
    return text + " of " + printable(file, 200);
}

std::string run_text(const RunRecord& run) {
    std::string out;
    if (run.frames.size() > 1) {
        for (const FrameRecord& frame : run.frames) {
            out += frame.title() + " (" + frame.result + ")\n";
            out += stats_text(frame.stats, StatsLevel::Shaders);
        }
        out += "all " + std::to_string(run.frames.size()) + " frames\n";
    }
    out += stats_text(run.total, StatsLevel::Full);
    for (const base::MessageRecord& m : run.messages) {
        append(out, "%16s  %s: %s (%s)\n", grouped(m.count).c_str(),
               std::string(base::severity_name(m.severity)).c_str(), printable(m.text, 300).c_str(),
               std::string(base::code_name(m.code)).c_str());
    }
    return out;
}

} // namespace trace
