// SPDX-License-Identifier: Apache-2.0
#include "runtime/descriptor_check.h"

#include "runtime/shader.h"

#include <algorithm>
#include <cstring>
#include <link.h>
#include <string_view>
#include <unordered_set>

namespace rt {

namespace {

// Generous; a larger count means that the descriptor is not one.
constexpr int max_count = 1 << 16;
constexpr int max_array_length = 1 << 16; // slc-010
constexpr int max_variants = 8;
constexpr std::size_t max_name = 4096;
constexpr std::size_t max_text = std::size_t{64} << 20; // literals, IR
constexpr std::uint32_t max_params_size = 1U << 28;
constexpr std::uint32_t max_frame_size = 1U << 24, max_frame_align = 4096;
constexpr std::uint32_t slot_alignment = 16;

struct Search {
    std::uintptr_t address;
    ObjectImage image;
};

int note_segments(dl_phdr_info* info, std::size_t, void* data) {
    auto& search = *static_cast<Search*>(data);
    ObjectImage image;
    bool is_it = false;
    for (int i = 0; i < info->dlpi_phnum; ++i) {
        const auto& segment = info->dlpi_phdr[i];
        if (segment.p_type != PT_LOAD) {
            continue;
        }
        const std::uintptr_t begin = info->dlpi_addr + segment.p_vaddr;
        const ObjectImage::Range range{begin, begin + segment.p_memsz};
        is_it = is_it || (search.address >= range.begin && search.address < range.end);
        if ((segment.p_flags & PF_R) != 0) {
            image.readable.push_back(range);
        }
        if ((segment.p_flags & PF_X) != 0) {
            image.executable.push_back(range);
        }
    }
    if (is_it) {
        search.image = std::move(image);
    }
    return is_it ? 1 : 0;
}

const ObjectImage::Range* range_of(const std::vector<ObjectImage::Range>& ranges,
                                   std::uintptr_t at) {
    const auto it = std::find_if(ranges.begin(), ranges.end(), [at](const ObjectImage::Range& r) {
        return at >= r.begin && at < r.end;
    });
    return it == ranges.end() ? nullptr : &*it;
}

class Checker {
public:
    Checker(const sl_object& object, const ObjectImage& image) : o_(object), image_(image) {}

    [[nodiscard]] std::string run() {
        if (!image_.holds(&o_, sizeof o_, alignof(sl_object))) {
            return "whose descriptor does not lie in it";
        }
        head();
        params();
        strings();
        variants();
        return std::move(why_);
    }

private:
    void require(bool ok, std::string_view what) {
        if (!ok && why_.empty()) {
            why_ = "with a descriptor that makes no sense (" + std::string(what) + ")";
        }
    }
    [[nodiscard]] bool is_name(const char* text) const {
        return image_.holds_text(text, max_name) && text[0] != '\0';
    }
    template <class T> bool array(int count, int most, const T* first, std::string_view what) {
        const bool ok =
            count >= 0 && count <= most &&
            (count == 0 ||
             image_.holds(first, static_cast<std::size_t>(count) * sizeof(T), alignof(T)));
        require(ok, what);
        return ok && why_.empty();
    }

    void head() {
        require(is_name(o_.fingerprint), "fingerprint");
        require(is_name(o_.name), "name");
        require(o_.type >= 0 && o_.type <= SL_SHADER_transformation, "type of shader");
        require(o_.source == nullptr || image_.holds_text(o_.source, max_name), "source");
        require(o_.ir == nullptr || image_.holds_text(o_.ir, max_text), "IR");
        constexpr std::uint64_t known = (std::uint64_t{1} << SL_VAR_COUNT) - 1;
        require(((o_.needed | o_.written | o_.needed_aux | o_.written_aux) & ~known) == 0,
                "variables");
    }

    void params() {
        require(o_.params_size <= max_params_size, "size of the parameters");
        if (!array(o_.num_params, max_count, o_.params, "parameters")) {
            return;
        }
        std::unordered_set<std::string_view> names;
        std::uint64_t end = 0; // of the slots before
        for (int i = 0; i < o_.num_params && why_.empty(); ++i) {
            const sl_param& p = o_.params[i];
            require(is_name(p.name) && names.insert(p.name).second, "name of a parameter");
            require(p.type > SL_TYPE_void && p.type <= SL_TYPE_string, "type of a parameter");
            require(p.detail == SL_DETAIL_uniform || p.detail == SL_DETAIL_varying,
                    "detail of a parameter");
            require(p.array_length >= 0 && p.array_length <= max_array_length,
                    "length of a parameter");
            require(p.is_output == 0 || p.is_output == 1, "direction of a parameter");
            require(p.needs_aux == 0 || (p.needs_aux == 1 && p.detail == SL_DETAIL_varying &&
                                         p.type != SL_TYPE_string),
                    "differences of a parameter");
            require(p.offset % slot_alignment == 0 && p.offset >= end, "place of a parameter");
            end = p.offset + bytes_of(p);
            require(end <= o_.params_size, "place of a parameter");
        }
    }

    // Value, and the pointer before a varying one.
    static std::uint64_t bytes_of(const sl_param& p) {
        const std::uint64_t unit = p.type == SL_TYPE_string ? sizeof(sl_string) : sizeof(float);
        const std::uint64_t value = unit * static_cast<std::uint64_t>(components_of(p.type)) *
                                    static_cast<std::uint64_t>(std::max(p.array_length, 1));
        return value + (p.detail == SL_DETAIL_varying ? slot_alignment : 0);
    }

    void strings() {
        if (!array(o_.num_strings, max_count, o_.strings, "texts")) {
            return;
        }
        for (int i = 0; i < o_.num_strings; ++i) {
            require(image_.holds_text(o_.strings[i], max_text), "a text");
        }
    }

    void variants() {
        require(o_.num_variants > 0, "variants");
        if (!array(o_.num_variants, max_variants, o_.variants, "variants")) {
            return;
        }
        for (int i = 0; i < o_.num_variants && why_.empty(); ++i) {
            const sl_variant* v = o_.variants[i];
            const bool lies_well = image_.holds(v, sizeof *v, alignof(sl_variant));
            require(lies_well, "a variant");
            if (lies_well) {
                variant(*v);
            }
        }
    }

    void variant(const sl_variant& v) {
        require((v.lanes == 1 || v.lanes == 4 || v.lanes == 8) &&
                    (v.isa == SL_ISA_any || v.isa == SL_ISA_avx2),
                "lanes");
        require(v.frame_size == 0 ||
                    (v.frame_size >= sizeof(sl_frame) && v.frame_size <= max_frame_size),
                "frames");
        require(v.frame_align <= max_frame_align && (v.frame_align & (v.frame_align - 1)) == 0,
                "frames");
        require(image_.holds_code(reinterpret_cast<std::uintptr_t>(v.shade)) &&
                    image_.holds_code(reinterpret_cast<std::uintptr_t>(v.init)),
                "entry points");
    }

    const sl_object& o_;
    const ObjectImage& image_;
    std::string why_;
};

} // namespace

ObjectImage ObjectImage::around(const void* address) {
    Search search{reinterpret_cast<std::uintptr_t>(address), {}};
    ::dl_iterate_phdr(note_segments, &search);
    return std::move(search.image);
}

bool ObjectImage::holds(const void* p, std::size_t bytes, std::size_t alignment) const {
    const auto at = reinterpret_cast<std::uintptr_t>(p);
    if (p == nullptr || at % alignment != 0) {
        return false;
    }
    const Range* range = range_of(readable, at);
    return readable.empty() || (range != nullptr && bytes <= range->end - at);
}

bool ObjectImage::holds_code(std::uintptr_t address) const {
    return address != 0 && (executable.empty() || range_of(executable, address) != nullptr);
}

bool ObjectImage::holds_text(const char* text, std::size_t max_length) const {
    if (text == nullptr) {
        return false;
    }
    const auto at = reinterpret_cast<std::uintptr_t>(text);
    const Range* range = range_of(readable, at);
    if (range == nullptr && !readable.empty()) {
        return false;
    }
    const std::size_t room =
        range == nullptr ? max_length : std::min<std::size_t>(range->end - at, max_length);
    return ::strnlen(text, room) < room;
}

std::string why_not_sound(const sl_object& object, const ObjectImage& image) {
    return Checker(object, image).run();
}

} // namespace rt
