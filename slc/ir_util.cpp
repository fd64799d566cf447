// SPDX-License-Identifier: Apache-2.0
#include "slc/ir_util.h"

namespace slc {

const OpInfo& op_info(Op op) {
    static constexpr OpInfo infos[] = {
#define SLC_OP(op, text, min_args, max_args, result, bodies)                                       \
    {text, min_args, max_args,                                                                     \
     (result) == 0   ? ResultUse::None                                                             \
     : (result) == 1 ? ResultUse::Always                                                           \
     : (result) == 2 ? ResultUse::Optional                                                         \
                     : ResultUse::Partial,                                                         \
     bodies},
#include "slc/ir_ops.def"
#undef SLC_OP
    };
    static_assert(std::size(infos) == static_cast<std::size_t>(Op::Solar) + 1);
    return infos[static_cast<std::size_t>(op)];
}

bool option_is_output(const Stmt& s, std::string_view name) {
    if (name.starts_with("send:")) {
        return false;
    }
    return s.op == Op::Call || name.starts_with("light:");
}

void renumber(Block& b, const std::vector<VarId>& to) {
    for (Stmt& s : b) {
        const auto move = [&](VarId& id) {
            id = id == no_var ? no_var : to[static_cast<std::size_t>(id)];
        };
        for (VarId& id : s.args) {
            move(id);
        }
        move(s.dst);
        move(s.category);
        for (auto& option : s.options) {
            move(option.second);
        }
        for (Block& inner : s.bodies) {
            renumber(inner, to);
        }
    }
}

WrittenVars::WrittenVars(const Program& program) {
    for (std::size_t i = 0; i < program.vars.size(); ++i) {
        const Var& v = program.vars[i];
        if (is_global(v) && v.index >= SL_VAR_L && v.index <= SL_VAR_Ol) {
            lights_[v.index - SL_VAR_L] = static_cast<VarId>(i);
        }
    }
}

void WrittenVars::add(const Stmt& s, std::unordered_set<VarId>& out) const {
    for_each_write(s, [&](VarId id, bool) { out.insert(id); });
    if (s.op == Op::Illuminance || s.op == Op::Illuminate || s.op == Op::Solar) {
        add_lights(out);
    }
    for (const Block& b : s.bodies) {
        for (const Stmt& inner : b) {
            add(inner, out);
        }
    }
}

void WrittenVars::add_lights(std::unordered_set<VarId>& out) const {
    for (const VarId id : lights_) {
        if (id != no_var) {
            out.insert(id);
        }
    }
}

} // namespace slc
