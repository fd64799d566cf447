// SPDX-License-Identifier: Apache-2.0
// Backward liveness over structured IR, per shading point: which variables are read later, and
// hence which statements matter. Strong form: operands of a statement that does not matter are not
// read. Loops are solved by repeating the whole walk until no set grows, so the cost is (nesting of
// loops + 2) walks.
#pragma once

#include "slc/ir.h"

#include <cstdint>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace slc {

// Variables by VarId; predefined variables by their id, so that those only built-ins read have a
// place too.
class VarSet {
public:
    VarSet() = default;
    explicit VarSet(const Program& program)
        : num_vars_(program.vars.size()), words_((num_vars_ + 3 * SL_VAR_COUNT + 63) / 64, 0) {}
    [[nodiscard]] std::size_t slot(const Program& program, VarId id) const {
        const Var& v = program.vars[static_cast<std::size_t>(id)];
        return v.kind == VarKind::Global ? global_slot(v.index, v.aux)
                                         : static_cast<std::size_t>(id);
    }
    [[nodiscard]] std::size_t global_slot(int variable, int aux = 0) const {
        return num_vars_ + static_cast<std::size_t>(aux * SL_VAR_COUNT + variable);
    }
    void insert(std::size_t slot) { words_[slot / 64] |= 1ull << (slot % 64); }
    void erase(std::size_t slot) { words_[slot / 64] &= ~(1ull << (slot % 64)); }
    [[nodiscard]] bool contains(std::size_t slot) const {
        return (words_[slot / 64] >> (slot % 64) & 1) != 0;
    }
    // True if something was added.
    bool merge(const VarSet& other);
    // Predefined variables, or their differences at an auxiliary point, as a needed mask.
    [[nodiscard]] std::uint64_t globals(int aux = 0) const;

private:
    std::size_t num_vars_ = 0;
    std::vector<std::uint64_t> words_;
};

class AuxAnalysis;

enum class LiveMode {
    Results, // what reaches the outputs of the shader, or is printed
    Aux,     // what reaches the arguments of area operators: the slice evaluated at the auxiliary
             // points
    Packets  // what any lane of a packet reads later, in code that runs whether it matters or not
};

// Predefined variables that statements of the block assign; in lights also what illuminate and
// solar set.
[[nodiscard]] std::uint64_t written_globals(const Program& program, const Block& b);

// Differences of predefined variables that the program assigns: results of displacement shaders.
[[nodiscard]] std::vector<VarId> written_differences(const Program& program);

class Liveness {
public:
    explicit Liveness(const Program& program)
        : Liveness(program, LiveMode::Results, nullptr, 0, nullptr) {}
    // The slice of all area operators and of `results` (predefined variables whose differences are
    // results), or of the one operator `only`. Without an analysis everything varying may differ.
    Liveness(const Program& program, const AuxAnalysis* aux, std::uint64_t results,
             const Stmt* only = nullptr)
        : Liveness(program, LiveMode::Aux, aux, results, only) {}
    [[nodiscard]] bool matters(const Stmt& s) const { return kept_.contains(&s); }
    // Slices: something assigned in the statement's bodies is read in the slice after it; the
    // variable is, or in the next round of the loop.
    [[nodiscard]] bool hands_on(const Stmt& s) const { return handed_on_.contains(&s); }
    [[nodiscard]] bool hands_on(const Stmt& s, VarId id) const { return find(handed_on_, s, id); }
    [[nodiscard]] bool next_round_reads(const Stmt& s, VarId id) const {
        return find(next_round_, s, id);
    }
    // Slices: the value of the area operator is read in the slice.
    [[nodiscard]] bool result_matters(const Stmt& s) const { return read_operators_.contains(&s); }
    [[nodiscard]] const VarSet& at_entry() const { return entry_; }

    // What must outlive each of the calls `wait`, while other lanes of the packet may be elsewhere:
    // in the other arm, out of the loop. What the call sets in all lanes is not in it.
    using Across = std::unordered_map<const Stmt*, VarSet>;
    [[nodiscard]] static Across across(const Program& program,
                                       const std::unordered_set<const Stmt*>& wait);

private:
    using Handed = std::unordered_map<const Stmt*, std::unordered_set<VarId>>;
    Liveness(const Program& program, LiveMode mode, const AuxAnalysis* aux, std::uint64_t results,
             const Stmt* only);
    static bool find(const Handed& handed, const Stmt& s, VarId id) {
        const auto it = handed.find(&s);
        return it != handed.end() && it->second.contains(id);
    }
    struct Target { // where a jump goes
        const Stmt* construct = nullptr;
        VarSet after_break; // Scope: after Leave
        VarSet after_continue;
        bool is_loop = false;
    };
    void solve();
    void block(const Block& b, VarSet& live);
    void statement(const Stmt& s, VarSet& live);
    void simple(const Stmt& s, VarSet& live);
    void jump(const Stmt& s, VarSet& live);
    void branch(const Stmt& s, VarSet& live);
    void loop(const Stmt& s, VarSet& live);
    void light_loop(const Stmt& s, VarSet& live);
    void illuminate(const Stmt& s, VarSet& live);
    void scope(const Stmt& s, VarSet& live);
    void read(VarId id, VarSet& live) const;
    void add_reads(const Stmt& s, VarSet& live) const;
    void add_area_reads(const Stmt& s, VarSet& live) const;
    [[nodiscard]] bool has_effect(const Stmt& s) const;
    [[nodiscard]] bool any_kept(const Stmt& s) const;
    void note_handed_on(const Stmt& s, const VarSet& after);
    void assigned_live(const Block& b, const VarSet& after, std::unordered_set<VarId>& found) const;
    void keep(const Stmt& s);
    // Set at the start of a loop body from the walk before; grows.
    VarSet& head(const Stmt& s);
    void exit_set(VarSet& live) const;
    std::size_t find_target(const Stmt& s) const;
    void note_across(const Stmt& s, const VarSet& live);
    // Lanes that do not run a block with the others need `live` meanwhile.
    void block_beside(const Block& b, VarSet& inside, const VarSet& live);

    const Program& program_;
    LiveMode mode_;
    const AuxAnalysis* aux_;
    std::uint64_t results_;
    const Stmt* only_;
    std::unordered_set<const Stmt*> kept_, read_operators_;
    Handed handed_on_, next_round_;
    std::unordered_map<const Stmt*, VarSet> heads_;
    std::vector<Target> targets_;
    VarSet entry_;
    bool changed_ = false;
    // LiveMode::Packets
    const std::unordered_set<const Stmt*>* wait_ = nullptr;
    Across across_;
    VarSet elsewhere_; // read later by lanes that are not in the block at hand
};

} // namespace slc
