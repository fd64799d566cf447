// SPDX-License-Identifier: Apache-2.0
#include "tracer/bad_values.h"

#include "tracer/execution.h"
#include "tracer/shader_set.h"

#include <algorithm>
#include <tuple>
#include <vector>

namespace trace {

namespace {

constexpr const char* texts[] = {
#define TRACE_BAD_RESULT(id, text) text,
#include "tracer/bad_values.def"
};

using Item = std::pair<BadValues::Key, BadValues::Case>;

// By shader, then kind: the same order in every run.
std::vector<Item> in_order(const BadValues& bad) {
    std::vector<Item> items(bad.cases().begin(), bad.cases().end());
    std::ranges::sort(items, [](const Item& a, const Item& b) {
        const auto rank = [](const Item& i) {
            return std::tuple(i.first.first->number, i.first.second, i.second.bucket,
                              i.first.first->pos.line);
        };
        return rank(a) < rank(b);
    });
    return items;
}

// The entry runs this instance while the object lives.
class Swap {
public:
    Swap(const ShaderEntry& entry, const rt::ShaderInstance& instance)
        : entry_(entry), before_(entry.special.exchange(&instance)) {}
    ~Swap() { entry_.special.store(before_); }
    Swap(const Swap&) = delete;
    Swap& operator=(const Swap&) = delete;

private:
    const ShaderEntry& entry_;
    const rt::ShaderInstance* before_;
};

BadPlace find_place(const ShaderEntry& entry, std::size_t bucket, rt::ShaderLibrary* library,
                    const ShadeAgain& shade_again) {
    BadPlace place;
    if (library == nullptr || !shade_again || !library->config().checked) {
        return place;
    }
    const auto order = library->config().checked(entry.object());
    const rt::ShaderObject* checked = order ? library->make_special(*order, {}) : nullptr;
    if (checked == nullptr || !rt::have_same_block(*checked, entry.instance->shader())) {
        return place;
    }
    const rt::ShaderInstance instance(*checked, *entry.instance);
    const Swap swap(entry, instance);
    place.shader = &entry;
    shade_again(bucket, place);
    return place;
}

} // namespace

void BadValues::note(const ShaderEntry& shader, BadResult result, std::uint64_t count) {
    if (count > 0) {
        add({&shader, result}, {count, bucket_});
    }
}

void BadValues::add(const Key& key, const Case& found) {
    const auto [it, is_new] = cases_.try_emplace(key, found);
    if (!is_new) {
        it->second.count += found.count;
        it->second.bucket = std::min(it->second.bucket, found.bucket);
    }
}

void BadValues::add(const BadValues& other) {
    for (const auto& [key, found] : other.cases_) {
        add(key, found);
    }
}

void report_bad_values(const FrameContext& frame, const BadValues& bad,
                       const ShadeAgain& shade_again) {
    std::vector<std::pair<std::uint32_t, BadResult>> told; // several instances, one message
    for (const auto& [key, found] : in_order(bad)) {
        const auto& [entry, result] = key;
        if (std::ranges::count(told, std::pair(entry->number, result)) > 0) {
            continue;
        }
        told.emplace_back(entry->number, result);
        const BadPlace place = find_place(*entry, found.bucket, frame.library, shade_again);
        std::string text = texts[static_cast<std::size_t>(result)];
        text += place.is_found() ? " (first seen here: " + place.text + ")" : "";
        report_shader(Execution(frame, *entry), base::Severity::Warning, place.line, text,
                      place.file);
    }
}

} // namespace trace
