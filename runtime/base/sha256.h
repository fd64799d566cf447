// SPDX-License-Identifier: Apache-2.0
// SHA-256 (FIPS 180-4) for content addresses: the ABI fingerprint, cache keys and the seal of
// shader objects. Not for secrets; any bytes go in, the same 64 hexadecimal digits come out on
// every machine.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace base {

class Sha256 {
public:
    using Digest = std::array<std::uint8_t, 32>;

    Sha256& add(std::string_view bytes);
    // A length goes in before the bytes, so that a sequence of fields is unambiguous.
    Sha256& add_field(std::string_view bytes);
    // Ends the hash; the object must not be used afterwards.
    [[nodiscard]] Digest digest();
    [[nodiscard]] std::string hex();

private:
    void block(const std::uint8_t* p);

    std::array<std::uint32_t, 8> h_ = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                       0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
    std::array<std::uint8_t, 64> pending_{};
    std::size_t num_pending_ = 0;
    std::uint64_t num_bytes_ = 0;
};

[[nodiscard]] std::string to_hex(const Sha256::Digest& digest);
[[nodiscard]] std::string sha256_hex(std::string_view bytes);

} // namespace base
