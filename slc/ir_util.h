// SPDX-License-Identifier: Apache-2.0
// Small questions about IR statements that printer, verifier, passes and emitters ask alike.
#pragma once

#include "slc/builtins.h"
#include "slc/ir.h"

#include <string_view>
#include <unordered_set>
#include <vector>

namespace slc {

enum class ResultUse : std::uint8_t { None, Always, Optional, Partial };

struct OpInfo {
    std::string_view text;
    int min_args, max_args;
    ResultUse result;
    int bodies;
};

[[nodiscard]] const OpInfo& op_info(Op op);

[[nodiscard]] inline const BuiltinRow& builtin_of(const Stmt& s) {
    return builtin_rows()[static_cast<std::size_t>(s.builtin)];
}

// Position in Stmt::args of argument i of the row's signature: the channel of texture functions is
// inserted.
[[nodiscard]] inline std::size_t arg_position(const BuiltinRow& row, std::size_t i) {
    return i + (row.has(PropChannel) && i > 0 ? 1 : 0);
}

// The predefined variable itself, not one of its differences.
[[nodiscard]] inline bool is_global(const Var& v) {
    return v.kind == VarKind::Global && v.aux == 0;
}
[[nodiscard]] inline bool is_global(const Var& v, int id) {
    return is_global(v) && v.index == id;
}

// Values held the same way: float, triple, matrix, string.
[[nodiscard]] inline bool same_class(Type a, Type b) {
    return a == b || (is_triple(a) && is_triple(b));
}

[[nodiscard]] inline bool is_loop(Op op) {
    return op == Op::Loop || op == Op::Illuminance;
}

// Options that set a variable: "light:x" of light statements, not "send:..."; all of calls.
[[nodiscard]] bool option_is_output(const Stmt& s, std::string_view name);

// Other shaders run meanwhile, or are asked, and may look at this one's output parameters: lights,
// message functions.
[[nodiscard]] inline bool shows_outputs(const Stmt& s) {
    if (s.op != Op::Call) {
        return s.op == Op::Illuminance;
    }
    const BuiltinRow& row = builtin_of(s);
    return row.has(PropLights) || (row.has(PropMessage) && row.has(PropState));
}

// Gives every variable the statements name, bodies included, the number to[id].
void renumber(Block& b, const std::vector<VarId>& to);

// What statements assign, bodies included, and L, Cl and Ol where light statements set them.
class WrittenVars {
public:
    explicit WrittenVars(const Program& program);
    void add(const Stmt& s, std::unordered_set<VarId>& out) const;
    // L, Cl and Ol before the body of illuminate and solar.
    void add_lights(std::unordered_set<VarId>& out) const;

private:
    VarId lights_[3] = {no_var, no_var, no_var};
};

// Calls read(id) for every variable whose value the statement itself uses, bodies not included.
// Partly changed arrays and output arguments that may keep their value count as read.
template <class F> void for_each_read(const Stmt& s, F read);

// Calls write(id, whole) for every variable the statement itself assigns. `whole`: in every lane
// that gets there, and all of it. Predefined variables that light statements set are not included.
template <class F> void for_each_write(const Stmt& s, F write);

template <class F> void for_each_read(const Stmt& s, F read) {
    if (s.op == Op::Call) {
        const BuiltinRow& row = builtin_of(s);
        std::size_t next_output = 0;
        for (std::size_t i = 0; i < s.args.size(); ++i) {
            while (next_output < row.args.size() &&
                   (!row.args[next_output].is_output || arg_position(row, next_output) < i)) {
                ++next_output;
            }
            const bool is_output =
                next_output < row.args.size() && arg_position(row, next_output) == i;
            if (!is_output || row.has(PropInout)) {
                read(s.args[i]);
            }
        }
        return;
    }
    for (const VarId id : s.args) {
        read(id);
    }
    if (s.op == Op::Store) {
        read(s.dst);
    }
    if (s.category != no_var) {
        read(s.category);
    }
    for (const auto& [name, id] : s.options) {
        read(id); // an option's variable keeps its value if nothing is found
    }
}

template <class F> void for_each_write(const Stmt& s, F write) {
    if (s.dst != no_var) {
        write(s.dst, s.op != Op::Store);
    }
    if (s.op == Op::Call) {
        const BuiltinRow& row = builtin_of(s);
        for (std::size_t i = 0; i < row.args.size(); ++i) {
            if (row.args[i].is_output && arg_position(row, i) < s.args.size()) {
                write(s.args[arg_position(row, i)], !row.has(PropInout));
            }
        }
    }
    for (const auto& [name, id] : s.options) {
        if (option_is_output(s, name)) {
            write(id, false);
        }
    }
}

} // namespace slc
