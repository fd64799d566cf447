// SPDX-License-Identifier: Apache-2.0
// When shaders are made again for the parameters of their instances: --specialise.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace trace {

enum class SpecialMode : std::uint8_t {
    Auto,  // where the work still to come repays the compiler
    Off,   // never
    Always // every instance, before the frame begins
};

[[nodiscard]] inline std::optional<SpecialMode> parse_special_mode(std::string_view text) {
    if (text == "auto") {
        return SpecialMode::Auto;
    }
    if (text == "off") {
        return SpecialMode::Off;
    }
    return text == "always" ? std::optional(SpecialMode::Always) : std::nullopt;
}

} // namespace trace
