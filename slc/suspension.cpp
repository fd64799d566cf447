// SPDX-License-Identifier: Apache-2.0
#include "slc/suspension.h"

#include "slc/ir_util.h"
#include "slc/liveness.h"

#include <algorithm>

namespace slc {

namespace {

void find_waiting(const Block& b, std::vector<const Stmt*>& found) {
    for (const Stmt& s : b) {
        if (s.op == Op::Call && builtin_of(s).has(PropWaits)) {
            found.push_back(&s);
        }
        for (const Block& inner : s.bodies) {
            find_waiting(inner, found);
        }
    }
}

// Has a value of its own in the code, which an entry does not restore by itself.
bool must_be_saved(const Var& v, bool is_written) {
    const bool is_input = v.kind == VarKind::Global || v.kind == VarKind::Param;
    const bool in_place =
        v.kind == VarKind::Param && v.aux == 0 && v.array_length > 0 && v.detail == Detail::Uniform;
    return v.kind != VarKind::Const && !in_place && (is_written || !is_input);
}

} // namespace

Suspensions::Suspensions(const Program& program) {
    std::vector<const Stmt*> calls;
    if (program.shader_type == SL_SHADER_surface) {
        find_waiting(program.body, calls);
    }
    if (calls.empty()) {
        return;
    }
    const Liveness::Across across = Liveness::across(program, {calls.begin(), calls.end()});
    std::unordered_set<VarId> written;
    const WrittenVars writes(program);
    for (const Stmt& s : program.body) {
        writes.add(s, written);
    }
    for (const Stmt* call : calls) {
        const VarSet& live = across.at(call);
        SuspensionPoint point{call, {}};
        for (std::size_t i = 0; i < program.vars.size(); ++i) {
            const auto v = static_cast<VarId>(i);
            if (live.contains(live.slot(program, v)) &&
                must_be_saved(program.vars[i], written.contains(v))) {
                point.saved.push_back(v);
                saved_.insert(v);
            }
        }
        points_.push_back(std::move(point));
        states_[call] = static_cast<int>(points_.size());
    }
}

std::size_t saved_bytes(const Var& v, int lanes) {
    const std::size_t unit = v.type == Type::String ? sizeof(sl_string) : sizeof(float);
    const std::size_t copies = v.detail == Detail::Varying ? static_cast<std::size_t>(lanes) : 1;
    return unit * copies * static_cast<std::size_t>(num_components(v.type)) *
           static_cast<std::size_t>(std::max(v.array_length, 1));
}

} // namespace slc
