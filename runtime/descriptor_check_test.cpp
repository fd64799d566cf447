// SPDX-License-Identifier: Apache-2.0
// A descriptor in memory of its own, right at first; then one thing after the other is broken.
#include "runtime/descriptor_check.h"

#include <cstring>
#include <functional>
#include <gtest/gtest.h>

namespace rt {
namespace {

struct Memory {
    char texts[64] = "finger\0name\0k\0q\0literal\0source";
    const char* strings[1] = {texts + 16};
    sl_param params[2] = {
        {texts + 12, SL_TYPE_color, SL_DETAIL_uniform, 0, 0, 0, 0},
        {texts + 14, SL_TYPE_float, SL_DETAIL_varying, 3, 1, 16, 0},
    };
    sl_variant variant{};
    const sl_variant* variants[1] = {&variant};
    sl_object object{};

    Memory() {
        variant.isa = SL_ISA_any;
        variant.lanes = 4;
        variant.shade = reinterpret_cast<decltype(variant.shade)>(texts);
        variant.init = reinterpret_cast<decltype(variant.init)>(texts);
        object.fingerprint = texts;
        object.name = texts + 7;
        object.num_params = 2;
        object.params = params;
        object.params_size = 48;
        object.num_strings = 1;
        object.strings = strings;
        object.num_variants = 1;
        object.variants = variants;
        object.source = texts + 24;
    }
    [[nodiscard]] std::string why() const {
        const auto begin = reinterpret_cast<std::uintptr_t>(this);
        return why_not_sound(object, {{{begin, begin + sizeof *this}}, {{begin, begin + 8}}});
    }
};

TEST(DescriptorCheck, TakesAGoodOne) {
    EXPECT_EQ(Memory().why(), "");
}

TEST(DescriptorCheck, ItsOwnProgram) {
    static const Memory memory;
    EXPECT_EQ(why_not_sound(memory.object, {}), "");
    EXPECT_FALSE(ObjectImage::around(&memory).readable.empty());
}

TEST(DescriptorCheck, RefusesWhatIsBroken) {
    static const char elsewhere[] = "elsewhere";
    const std::function<void(Memory&)> breaks[] = {
        [](Memory& m) { m.object.fingerprint = nullptr; },
        [](Memory& m) { m.object.name = elsewhere; },
        [](Memory& m) { m.object.name = m.texts + 6; }, // empty
        [](Memory& m) { m.object.type = 77; },
        [](Memory& m) { m.object.needed = ~0ULL; },
        [](Memory& m) { m.object.num_params = -1; },
        [](Memory& m) { m.object.num_params = 60000; },
        [](Memory& m) { m.object.params = nullptr; },
        [](Memory& m) { m.object.params_size = 40; },
        [](Memory& m) { m.object.params_size = ~0U; },
        [](Memory& m) { m.params[1].offset = 8; },
        [](Memory& m) { m.params[1].offset = 0; },
        [](Memory& m) { m.params[1].offset = 0xfffffff0U; },
        [](Memory& m) { m.params[1].array_length = 1000; },
        [](Memory& m) { m.params[1].array_length = -1; },
        [](Memory& m) { m.params[0].type = SL_TYPE_void; },
        [](Memory& m) { m.params[0].detail = 2; },
        [](Memory& m) { m.params[0].is_output = 5; },
        [](Memory& m) { m.params[0].needs_aux = 1; }, // uniform
        [](Memory& m) { m.object.written_aux = 1ULL << 63; },
        [](Memory& m) { m.params[0].name = m.params[1].name; },
        [](Memory& m) { m.strings[0] = elsewhere; },
        [](Memory& m) { m.object.num_variants = 0; },
        [](Memory& m) { m.variants[0] = nullptr; },
        [](Memory& m) { m.variant.lanes = 16; },
        [](Memory& m) { m.variant.frame_size = 1; },
        [](Memory& m) { m.variant.frame_align = 3; },
        [](Memory& m) { m.variant.init = nullptr; },
        [](Memory& m) { m.variant.shade = reinterpret_cast<decltype(m.variant.shade)>(&m + 1); },
        [](Memory& m) { m.object.source = elsewhere; },
    };
    for (std::size_t i = 0; i < std::size(breaks); ++i) {
        Memory memory;
        breaks[i](memory);
        EXPECT_NE(memory.why(), "") << "case " << i;
    }
}

} // namespace
} // namespace rt
