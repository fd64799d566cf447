// SPDX-License-Identifier: Apache-2.0
// Irradiance records in a file: Option "indirect" "savefile" and "seedfile". Records are in world
// space, so that they serve other cameras. A header names format and count, a hash at the end
// covers everything; what does not match is refused, whatever it holds. Little-endian.
#pragma once

#include "tracer/irradiance_cache.h"

#include <span>
#include <string>
#include <vector>

namespace trace {

// "" or why not. The file appears when it is complete.
[[nodiscard]] std::string write_irradiance(const std::string& path,
                                           std::span<const IrradianceRecord> records);

struct IrradianceFile {
    std::vector<IrradianceRecord> records; // sound ones only
    std::string error;                     // not empty: nothing was read
};
[[nodiscard]] IrradianceFile read_irradiance(const std::string& path);

} // namespace trace
