// SPDX-License-Identifier: Apache-2.0
// The block stack and what is legal where (ri.md, section 5).
#pragma once

#include "ribtools/request.h"
#include "runtime/base/diag.h"

#include <string>
#include <vector>

namespace rib {

class Blocks {
public:
    struct Block {
        BlockKind kind;
        base::SourcePos pos; // of the request that opened it
    };
    // More are refused: each costs a saved state, and no sane file comes near.
    static constexpr std::size_t max_depth = 100'000;

    [[nodiscard]] std::size_t depth() const { return stack_.size(); }
    [[nodiscard]] BlockKind innermost() const {
        return stack_.empty() ? BlockKind::None : stack_.back().kind;
    }
    [[nodiscard]] const Block& top() const { return stack_.back(); }
    [[nodiscard]] bool inside(BlockKind kind) const { return find(kind) > 0; }
    // Depth (from 1) of the innermost block of this kind, 0 if none is open.
    [[nodiscard]] std::size_t find(BlockKind kind) const;

    void push(BlockKind kind, base::SourcePos pos);
    void pop();

    // Legal here? Attribute, Transform, Solid and Resource blocks pass on what encloses them: a row
    // must allow both the innermost block and the nearest one of another kind.
    [[nodiscard]] bool is_legal(const RequestRow& row) const;
    // Where the row is not legal: "inside WorldBegin", "outside a world": for messages.
    [[nodiscard]] std::string where(const RequestRow& row) const;

private:
    [[nodiscard]] BlockKind enclosing() const;

    std::vector<Block> stack_;
    std::vector<std::size_t> open_count_ = std::vector<std::size_t>(9);
};

// The error code for a request at an illegal place.
[[nodiscard]] base::Code illegal_code(RequestKind kind);

} // namespace rib
