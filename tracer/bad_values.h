// SPDX-License-Identifier: Apache-2.0
// Results of shaders that are no numbers: none reaches a pixel, each is counted, and after the
// frame every shader that made one is reported once, with the place where it first arose. In:
// what threads noted while they shaded. The place is found by shading the first bucket in question
// once more with checked code (slc/emit_check.cpp), which tells it; the order of buckets is that of
// the picture, so messages do not depend on threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>

namespace trace {

struct FrameContext;
struct ShaderEntry;

// What was no number, and so what was done.
enum class BadResult : std::uint8_t {
#define TRACE_BAD_RESULT(id, text) id,
#include "tracer/bad_values.def"
};

// Of one thread, or of the frame.
class BadValues {
public:
    struct Case {
        std::uint64_t count = 0;
        std::size_t bucket = 0; // the first one
    };
    using Key = std::pair<const ShaderEntry*, BadResult>;

    void begin_bucket(std::size_t bucket) { bucket_ = bucket; }
    void note(const ShaderEntry& shader, BadResult result, std::uint64_t count);
    void add(const BadValues& other);
    [[nodiscard]] const std::map<Key, Case>& cases() const { return cases_; }

private:
    void add(const Key& key, const Case& found);
    std::map<Key, Case> cases_;
    std::size_t bucket_ = 0;
};

// Where checked code says that numbers end; the first place counts.
struct BadPlace {
    const ShaderEntry* shader = nullptr; // of interest
    std::string file;
    int line = 0;
    std::string text;
    [[nodiscard]] bool is_found() const { return line > 0; }
};

// Shades something again: a bucket (or, for imagers, a batch) by its number, telling `place`.
using ShadeAgain = std::function<void(std::size_t bucket, BadPlace& place)>;

// One message per shader and kind of result. Nobody may be shading. `shade_again` may be empty;
// without a compiler or IR messages name no line.
void report_bad_values(const FrameContext& frame, const BadValues& bad,
                       const ShadeAgain& shade_again);

} // namespace trace
