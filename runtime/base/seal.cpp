// SPDX-License-Identifier: Apache-2.0
#include "runtime/base/seal.h"

#include "runtime/base/sha256.h"

namespace base {

namespace {

constexpr std::string_view magic = "\nperigee-object ";
constexpr std::size_t hex_digits = 64;
constexpr std::size_t seal_size =
    magic.size() + 2 * hex_digits + 2; // fingerprint, space, hash, newline

} // namespace

std::string seal(std::string_view content, std::string_view fingerprint) {
    std::string out(magic);
    out.append(fingerprint);
    out += ' ';
    out += sha256_hex(content);
    out += '\n';
    return out;
}

SealState check_seal(std::string_view sealed, std::string_view fingerprint) {
    if (sealed.size() < seal_size) {
        return SealState::Missing;
    }
    const std::string_view trailer = sealed.substr(sealed.size() - seal_size);
    if (!trailer.starts_with(magic)) {
        return SealState::Missing;
    }
    if (trailer.substr(magic.size(), hex_digits) != fingerprint) {
        return SealState::OtherFingerprint;
    }
    const std::string_view content = sealed.substr(0, sealed.size() - seal_size);
    return sha256_hex(content) == sealed_hash(sealed) ? SealState::Good : SealState::Damaged;
}

std::string_view sealed_hash(std::string_view sealed) {
    return sealed.substr(sealed.size() - hex_digits - 1, hex_digits);
}

} // namespace base
