// SPDX-License-Identifier: Apache-2.0
// How the page of --report looks and the script that sorts its tables: constants, so that the page
// needs nothing from elsewhere.
#pragma once

#include <string_view>

namespace trace {

extern const std::string_view report_css;
extern const std::string_view report_script;

} // namespace trace
