// SPDX-License-Identifier: Apache-2.0
#include "slc/externals.h"

namespace slc {

const std::vector<const BuiltinRow*>& Externals::find(const std::string& name) {
    const auto [it, is_new] = rows_.try_emplace(name);
    if (is_new && find_) {
        for (ExternalFunction& function : find_(name)) {
            Entry& entry = entries_.emplace_back();
            entry.function = std::move(function);
            entry.row = decode_row(entry.function.name, entry.function.signature,
                                   PropContext | PropVaries | PropEffect);
            it->second.push_back(&entry.row);
        }
    }
    return it->second;
}

} // namespace slc
