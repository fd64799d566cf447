// SPDX-License-Identifier: Apache-2.0
// Is the descriptor of a loaded shader object what the rest of the engine takes it for? In: an
// sl_object and the memory its object occupies. Out: what is wrong, or nothing; then every pointer
// in it leads into the object, every text ends, parameters lie in their block one after the other,
// counts and sizes are bounded. The code of an object cannot be checked: objects are trusted as the
// folders they come from.
#pragma once

#include "runtime/abi/sl_abi.h"

#include <cstdint>
#include <string>
#include <vector>

namespace rt {

// Memory of one object, as the dynamic linker mapped it. Without ranges everything counts as its
// own: objects that are linked into the program.
struct ObjectImage {
    struct Range {
        std::uintptr_t begin, end;
    };
    std::vector<Range> readable, executable;

    // Of the object in which `address` lies.
    [[nodiscard]] static ObjectImage around(const void* address);

    [[nodiscard]] bool holds(const void* p, std::size_t bytes, std::size_t alignment = 1) const;
    [[nodiscard]] bool holds_code(std::uintptr_t address) const;
    // A text with its end, of at most max_length bytes.
    [[nodiscard]] bool holds_text(const char* text, std::size_t max_length) const;
};

// Empty: sound. The fingerprint is the caller's to compare, once this says that it is a text.
[[nodiscard]] std::string why_not_sound(const sl_object& object, const ObjectImage& image);

} // namespace rt
