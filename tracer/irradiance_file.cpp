// SPDX-License-Identifier: Apache-2.0
#include "tracer/irradiance_file.h"

#include "runtime/base/file.h"
#include "runtime/base/sha256.h"

#include <array>
#include <bit>
#include <cstring>
#include <optional>
#include <string_view>

namespace trace {

namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::string_view magic = "Perigee irradiance 1\n";
constexpr std::size_t floats_per_record = 29; // P, N, mean, 3 + 3 gradients, radius, error
constexpr std::size_t record_bytes = floats_per_record * sizeof(float);
constexpr std::size_t header_bytes = magic.size() + sizeof(std::uint64_t);
constexpr std::size_t hash_bytes = sizeof(base::Sha256::Digest);
constexpr std::size_t max_bytes = std::size_t{4} << 30;

using Floats = std::array<float, floats_per_record>;

// One place knows the order: `act` is told every number of a record.
template <class Record, class Act> void each_number(Record& r, Act act) {
    const auto triple = [&](auto& v) { act(v.x), act(v.y), act(v.z); };
    triple(r.P);
    triple(r.N);
    act(r.mean.r), act(r.mean.g), act(r.mean.b);
    for (std::size_t k = 0; k < 3; ++k) {
        triple(r.rotation[k]);
        triple(r.translation[k]);
    }
    act(r.radius);
    act(r.max_error);
}

base::Sha256::Digest hash_of(std::string_view bytes) {
    return base::Sha256().add(bytes).digest();
}

void append(std::string& bytes, const void* data, std::size_t count) {
    bytes.append(static_cast<const char*>(data), count);
}

// The number of records, if header, length and hash agree.
std::optional<std::uint64_t> checked_count(std::string_view bytes) {
    if (bytes.size() < header_bytes + hash_bytes || !bytes.starts_with(magic)) {
        return std::nullopt;
    }
    std::uint64_t count = 0;
    std::memcpy(&count, bytes.data() + magic.size(), sizeof count);
    const std::size_t body = bytes.size() - header_bytes - hash_bytes;
    if (body % record_bytes != 0 || count != body / record_bytes) {
        return std::nullopt;
    }
    const base::Sha256::Digest hash = hash_of(bytes.substr(0, header_bytes + body));
    const bool matches =
        std::memcmp(hash.data(), bytes.data() + header_bytes + body, hash_bytes) == 0;
    return matches ? std::optional(count) : std::nullopt;
}

} // namespace

std::string write_irradiance(const std::string& path, std::span<const IrradianceRecord> records) {
    std::string bytes(magic);
    bytes.reserve(header_bytes + records.size() * record_bytes + hash_bytes);
    const std::uint64_t count = records.size();
    append(bytes, &count, sizeof count);
    for (const IrradianceRecord& record : records) {
        Floats floats{};
        std::size_t at = 0;
        each_number(record, [&](float x) { floats[at++] = x; });
        append(bytes, floats.data(), record_bytes);
    }
    const base::Sha256::Digest hash = hash_of(bytes);
    append(bytes, hash.data(), hash_bytes);
    return base::write_file_atomically(path, bytes);
}

IrradianceFile read_irradiance(const std::string& path) {
    IrradianceFile file;
    const std::optional<std::string> bytes = base::read_file(path, max_bytes);
    if (!bytes) {
        file.error = "cannot be read";
        return file;
    }
    const std::optional<std::uint64_t> count = checked_count(*bytes);
    if (!count) {
        file.error = "is damaged, or no file of irradiance records of this version";
        return file;
    }
    file.records.reserve(*count);
    for (std::uint64_t i = 0; i < *count; ++i) {
        Floats floats{};
        std::memcpy(floats.data(), bytes->data() + header_bytes + i * record_bytes, record_bytes);
        IrradianceRecord record;
        std::size_t at = 0;
        each_number(record, [&](float& x) { x = floats[at++]; });
        if (is_sound(record)) {
            file.records.push_back(record);
        }
    }
    return file;
}

} // namespace trace
