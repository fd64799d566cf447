// SPDX-License-Identifier: Apache-2.0
#include "runtime/shader.h"

namespace rt {

sl_string StringTable::intern(std::string_view text) {
    text = text.substr(0, text.find('\0'));
    const std::lock_guard lock(mutex_);
    auto it = texts_.find(text);
    if (it == texts_.end()) {
        it = texts_.emplace(text).first;
    }
    return it->c_str();
}

} // namespace rt
