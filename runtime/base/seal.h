// SPDX-License-Identifier: Apache-2.0
// Sealed files: a trailer after the content names the ABI and the content's hash, so that a shader
// object can be refused before the dynamic linker touches it (truncated, damaged, made for other
// tables, or no object at all). The trailer is fixed-size text behind the end of the ELF image,
// which ignores it.
#pragma once

#include <string>
#include <string_view>

namespace base {

[[nodiscard]] std::string seal(std::string_view content, std::string_view fingerprint);

enum class SealState { Good, Missing, Damaged, OtherFingerprint };

[[nodiscard]] SealState check_seal(std::string_view sealed, std::string_view fingerprint);

// Hash of the content as a good seal names it; hexadecimal.
[[nodiscard]] std::string_view sealed_hash(std::string_view sealed);

} // namespace base
