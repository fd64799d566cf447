// SPDX-License-Identifier: Apache-2.0
// FIPS 180-4, sections 4.1.2, 5.1.1, 6.2.
#include "runtime/base/sha256.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace base {

namespace {

constexpr std::uint32_t round_constants[64] = {
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

std::uint32_t big_endian(const std::uint8_t* p) {
    return static_cast<std::uint32_t>(p[0]) << 24 | static_cast<std::uint32_t>(p[1]) << 16 |
           static_cast<std::uint32_t>(p[2]) << 8 | p[3];
}

} // namespace

void Sha256::block(const std::uint8_t* p) {
    std::uint32_t w[64];
    for (int i = 0; i < 16; ++i) {
        w[i] = big_endian(p + 4 * i);
    }
    for (int i = 16; i < 64; ++i) {
        const std::uint32_t s0 =
            std::rotr(w[i - 15], 7) ^ std::rotr(w[i - 15], 18) ^ w[i - 15] >> 3;
        const std::uint32_t s1 = std::rotr(w[i - 2], 17) ^ std::rotr(w[i - 2], 19) ^ w[i - 2] >> 10;
        w[i] = w[i - 16] + s0 + w[i - 7] + s1;
    }
    auto [a, b, c, d, e, f, g, h] = h_;
    for (int i = 0; i < 64; ++i) {
        const std::uint32_t s1 = std::rotr(e, 6) ^ std::rotr(e, 11) ^ std::rotr(e, 25);
        const std::uint32_t t1 = h + s1 + ((e & f) ^ (~e & g)) + round_constants[i] + w[i];
        const std::uint32_t s0 = std::rotr(a, 2) ^ std::rotr(a, 13) ^ std::rotr(a, 22);
        const std::uint32_t t2 = s0 + ((a & b) ^ (a & c) ^ (b & c));
        h = g;
        g = f;
        f = e;
        e = d + t1;
        d = c;
        c = b;
        b = a;
        a = t1 + t2;
    }
    const std::uint32_t add[8] = {a, b, c, d, e, f, g, h};
    for (std::size_t i = 0; i < 8; ++i) {
        h_[i] += add[i];
    }
}

Sha256& Sha256::add(std::string_view bytes) {
    const auto* p = reinterpret_cast<const std::uint8_t*>(bytes.data());
    std::size_t n = bytes.size();
    num_bytes_ += n;
    if (num_pending_ > 0) {
        const std::size_t take = std::min(n, pending_.size() - num_pending_);
        std::memcpy(pending_.data() + num_pending_, p, take);
        num_pending_ += take;
        p += take;
        n -= take;
        if (num_pending_ < pending_.size()) {
            return *this;
        }
        block(pending_.data());
        num_pending_ = 0;
    }
    for (; n >= pending_.size(); n -= pending_.size(), p += pending_.size()) {
        block(p);
    }
    if (n > 0) {
        std::memcpy(pending_.data(), p, n);
    }
    num_pending_ = n;
    return *this;
}

Sha256& Sha256::add_field(std::string_view bytes) {
    return add(std::to_string(bytes.size()) + ":").add(bytes);
}

Sha256::Digest Sha256::digest() {
    const std::uint64_t num_bits = num_bytes_ * 8;
    add(std::string_view("\x80", 1));
    while (num_pending_ != 56) {
        add(std::string_view("\0", 1));
    }
    char length[8];
    for (int i = 0; i < 8; ++i) {
        length[i] = static_cast<char>(num_bits >> (56 - 8 * i) & 0xff);
    }
    add(std::string_view(length, 8));
    Digest out;
    for (std::size_t i = 0; i < out.size(); ++i) {
        out[i] = static_cast<std::uint8_t>(h_[i / 4] >> (24 - 8 * (i % 4)));
    }
    return out;
}

std::string to_hex(const Sha256::Digest& digest) {
    constexpr char digits[] = "0123456789abcdef";
    std::string out;
    for (const std::uint8_t byte : digest) {
        out += digits[byte >> 4];
        out += digits[byte & 15];
    }
    return out;
}

std::string Sha256::hex() {
    return to_hex(digest());
}

std::string sha256_hex(std::string_view bytes) {
    return Sha256().add(bytes).hex();
}

} // namespace base
