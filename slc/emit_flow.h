// SPDX-License-Identifier: Apache-2.0
// What the emitter must know about control flow before it writes a line: which constructs need
// masks, which exits are plain jumps, and where each variable lives. In: a program (uniform/varying
// decided). Out: side tables keyed by the program's own statements and blocks, which must not move.
// Never changes the program.
#pragma once

#include "slc/ir.h"

#include <unordered_map>
#include <vector>

namespace slc {

// A block *shares* its parent's mask when every lane that reaches the statement it belongs to runs
// it.
struct BlockInfo {
    const Block* parent = nullptr;
    const Stmt* owner = nullptr; // null for the shader body
    bool shares_mask = true;
};

// Loop, Scope, Illuminance.
struct ConstructInfo {
    bool masked = false;              // lanes leave it at different times
    bool has_masked_continue = false; // ... or skip the rest of an iteration
};

// Break, Continue, Leave.
struct ExitInfo {
    const Stmt* target = nullptr;
    bool masked = false; // false: all lanes still in the target go together, a jump does it
};

// Where a variable is declared and whether its first access there sets it.
struct VarPlace {
    const Block* home = nullptr; // null: never used
    bool set_first = false;      // first access is an assignment of all of it, directly in `home`
    bool is_read = false;
    bool is_written = false;
    int num_reads = 0;
    int num_writes = 0;
};

class Flow {
public:
    // `body` is the shader's body or a default expression; the latter is all uniform. `results`:
    // the predefined variables (bits 1 << sl_variable) that are stored at the end.
    Flow(const Program& program, const Block& body, std::uint64_t results, bool all_uniform);

    [[nodiscard]] const BlockInfo& block(const Block& b) const { return blocks_.at(&b); }
    [[nodiscard]] const ConstructInfo& construct(const Stmt& s) const { return constructs_.at(&s); }
    [[nodiscard]] const ExitInfo& exit(const Stmt& s) const { return exits_.at(&s); }
    [[nodiscard]] const VarPlace& place(VarId v) const {
        return places_[static_cast<std::size_t>(v)];
    }
    // Statement holds a masked exit to something outside of it: lanes may be missing after it.
    [[nodiscard]] bool loses_lanes(const Stmt& s) const { return losing_.count(&s) > 0; }
    // An assignment in `b` must leave the lanes alone that are not in b's mask.
    [[nodiscard]] bool must_blend(VarId v, const Block& b) const;
    [[nodiscard]] bool is_varying(VarId v) const;
    // The program's variable for a predefined one, or no_var.
    [[nodiscard]] VarId global(sl_variable id) const;

private:
    struct Access {
        const Block* block;
        bool sets_all; // unconditional assignment of the whole variable at statement level
    };

    void index(const Block& b, const Block* parent, const Stmt* owner,
               std::vector<const Stmt*>& enclosing);
    void note_exit(const Stmt& s, const std::vector<const Stmt*>& enclosing);
    void decide_masks();
    void update_sharing();
    bool decide_exit(const Stmt& s, ExitInfo& info);
    void note_losses();
    void place_block(const Block& b);
    void place_statement(const Stmt& s, const Block& b);
    void settle_places(std::uint64_t results);
    void read(VarId v, const Block& b);
    void write(VarId v, const Block& b, bool sets_all);
    void access(VarId v, const Block& b, bool sets_all);
    [[nodiscard]] const Block* common(const Block* a, const Block* b) const;

    const Program& program_;
    const Block& body_;
    bool all_uniform_;
    std::unordered_map<const Block*, BlockInfo> blocks_;
    std::unordered_map<const Stmt*, ConstructInfo> constructs_;
    std::unordered_map<const Stmt*, ExitInfo> exits_;
    std::unordered_map<const Stmt*, const Block*> exit_blocks_;
    std::vector<const Stmt*> exit_order_;
    std::unordered_map<const Stmt*, bool> losing_;
    std::vector<VarPlace> places_;
    std::vector<const Block*> first_block_;
    std::vector<bool> first_sets_;
};

} // namespace slc
