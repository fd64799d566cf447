// SPDX-License-Identifier: Apache-2.0
// Statistics that a RIB file asks for: Option "statistics" "endofframe" and "filename", Option
// "runtime" "verbosity". In: options and record of each finished frame. Out: text on standard
// output, or a file that holds the frames of the run so far.
#pragma once

#include "tracer/run_record.h"

#include <map>
#include <string>

namespace trace {

enum class Verbosity : std::uint8_t { Silent, Normal, Stats, Debug };
// Normal where the option is missing or has another value.
[[nodiscard]] Verbosity verbosity_of(const rib::Param* option);
[[nodiscard]] Verbosity verbosity_of(const rib::Options& options);

class FrameStatistics {
public:
    explicit FrameStatistics(base::Diag& diag) : diag_(diag) {}
    // False after a message if the file could not be written.
    bool tell(const rib::Options& options, const FrameRecord& frame);

private:
    base::Diag& diag_;
    std::map<std::string, std::string> texts_; // by file
};

} // namespace trace
