// SPDX-License-Identifier: Apache-2.0
// What the fuzz targets of the reader have in common. In: any bytes. Nothing may crash, hang or
// grow beyond the input; and what is written must be read back as it was (a failure aborts).
#pragma once

#include "ribtools/rib_source.h"
#include "runtime/base/fuzz.h"

#include <memory>
#include <string>

namespace rib_fuzz {

// Reads the stream into a scene, and converts it to text, to binary, and back.
void read_and_convert(const std::string& stream);

} // namespace rib_fuzz
