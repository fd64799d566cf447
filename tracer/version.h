// SPDX-License-Identifier: Apache-2.0
// Who we are: rendererinfo(), --version. PERIGEE_VERSION comes from the project line of
// meson.build.
#pragma once

#include <array>

namespace trace {

inline constexpr const char* renderer_name = "Perigee";
inline constexpr const char* renderer_version_text = PERIGEE_VERSION;

// major, minor, revision, patch
constexpr std::array<float, 4> parse_version(const char* text) {
    std::array<float, 4> parts{};
    for (std::size_t i = 0; i < parts.size() && *text != '\0'; ++i) {
        for (; *text >= '0' && *text <= '9'; ++text) {
            parts[i] = parts[i] * 10 + static_cast<float>(*text - '0');
        }
        text += *text == '.' ? 1 : 0;
    }
    return parts;
}
inline constexpr std::array<float, 4> renderer_version = parse_version(renderer_version_text);

} // namespace trace
