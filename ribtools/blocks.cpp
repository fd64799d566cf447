// SPDX-License-Identifier: Apache-2.0
#include "ribtools/blocks.h"

namespace rib {

std::size_t Blocks::find(BlockKind kind) const {
    if (open_count_[static_cast<std::size_t>(kind)] == 0) {
        return 0;
    }
    std::size_t depth = stack_.size();
    while (stack_[depth - 1].kind != kind) {
        --depth;
    }
    return depth;
}

void Blocks::push(BlockKind kind, base::SourcePos pos) {
    stack_.push_back({kind, pos});
    ++open_count_[static_cast<std::size_t>(kind)];
}

void Blocks::pop() {
    --open_count_[static_cast<std::size_t>(stack_.back().kind)];
    stack_.pop_back();
}

// The nearest block that is not one of those that only save state. They can only lie inside one of
// these four.
BlockKind Blocks::enclosing() const {
    const auto is_open = [&](BlockKind kind) {
        return open_count_[static_cast<std::size_t>(kind)] > 0;
    };
    return is_open(BlockKind::Object)  ? BlockKind::Object
           : is_open(BlockKind::World) ? BlockKind::World
           : is_open(BlockKind::Frame) ? BlockKind::Frame
                                       : BlockKind::None;
}

bool Blocks::is_legal(const RequestRow& row) const {
    const BlockKind inner = innermost();
    const unsigned allowed = row.scopes;
    if (inner == BlockKind::Motion) {
        return (allowed & scopes::bit(BlockKind::Motion)) != 0;
    }
    return (allowed & scopes::bit(inner)) != 0 && (allowed & scopes::bit(enclosing())) != 0;
}

std::string Blocks::where(const RequestRow& row) const {
    if (row.kind == RequestKind::Primitive && enclosing() != BlockKind::World &&
        enclosing() != BlockKind::Object) {
        return "outside a world";
    }
    // Of the two blocks that decide, name the one at fault.
    const bool inner_allows = (row.scopes & scopes::bit(innermost())) != 0;
    const BlockKind kind = inner_allows ? enclosing() : innermost();
    return kind == BlockKind::None ? "outside every block"
                                   : "inside " + std::string(block_name(kind)) + "Begin";
}

base::Code illegal_code(RequestKind kind) {
    switch (kind) {
    case RequestKind::Option:
    case RequestKind::Texture:
        return base::Code::NotOptions;
    case RequestKind::Attribute:
    case RequestKind::Transform:
        return base::Code::NotAttribs;
    case RequestKind::Primitive:
        return base::Code::NotPrims;
    case RequestKind::Block:
        return base::Code::Nesting;
    case RequestKind::Other:
    case RequestKind::Skipped:
        return base::Code::IllState;
    }
    return base::Code::IllState;
}

} // namespace rib
