// SPDX-License-Identifier: Apache-2.0
// Inline archives (ArchiveBegin, ri.md 6.12): recordings found by name.
#pragma once

#include "ribtools/rib_lex.h"

#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

namespace rib {

struct InlineArchive {
    std::string name;
    std::shared_ptr<const Recording> recording;
};

class Archives {
public:
    void add(InlineArchive archive) {
        latest_[archive.name] = archives_.size();
        archives_.push_back(std::move(archive));
    }
    // The latest of this name; nullptr if there is none.
    [[nodiscard]] const InlineArchive* find(const std::string& name) const {
        const auto it = latest_.find(name);
        return it == latest_.end() ? nullptr : &archives_[it->second];
    }
    [[nodiscard]] std::size_t size() const { return archives_.size(); }
    // Forgets all but the first n: those made in a frame or world go with it.
    void keep(std::size_t n) {
        if (n >= archives_.size()) {
            return;
        }
        archives_.erase(archives_.begin() + static_cast<std::ptrdiff_t>(n), archives_.end());
        latest_.clear();
        for (std::size_t i = 0; i < archives_.size(); ++i) {
            latest_[archives_[i].name] = i;
        }
    }

private:
    std::vector<InlineArchive> archives_;
    std::unordered_map<std::string, std::size_t> latest_;
};

} // namespace rib
