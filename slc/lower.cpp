// SPDX-License-Identifier: Apache-2.0
// Frame of lowering: parameters with their defaults, variables, constants, and what a shader type
// allows.
#include "slc/lower.h"

#include "slc/builtins.h"

#include <algorithm>
#include <bit>
#include <numbers>

namespace slc {

using ast::Symbol;
using ast::SymbolKind;

std::optional<Program> lower(const ast::Shader& shader, Messages& messages) {
    return Lowering(shader, messages).run();
}

Lowering::Deeper::Deeper(Lowering& lowering, Loc loc) : lowering_(lowering) {
    if (++lowering_.depth_ > max_depth) {
        lowering_.messages_.error(
            loc, "expressions, blocks and function calls are nested too deeply here",
            base::Code::Limit);
        throw Overflow{};
    }
}

std::optional<Program> Lowering::run() {
    const std::size_t errors_before = messages_.num_errors();
    std::fill(std::begin(globals_), std::end(globals_), no_var);
    std::fill(std::begin(global_copies_), std::end(global_copies_), no_var);
    program_.name = shader_.name;
    program_.shader_type = shader_.type;
    for (const VariableRow& row : variable_rows()) {
        names_.emplace(row.name);
    }
    try {
        params();
        block_ = &program_.body;
        local_copies();
        body(shader_.body);
        program_.body.insert(program_.body.begin(), std::make_move_iterator(prologue_.begin()),
                             std::make_move_iterator(prologue_.end()));
    } catch (const Overflow&) {
        return std::nullopt;
    }
    if (messages_.num_errors() != errors_before) {
        return std::nullopt;
    }
    return std::move(program_);
}

// Parameters come first and keep their names; a default may use earlier ones.
void Lowering::params() {
    in_init_ = true;
    for (const ast::Variable& p : shader_.params) {
        const Symbol& symbol = *p.symbol;
        Var v;
        v.name = symbol.name;
        v.type = symbol.type;
        v.detail = symbol.detail.value_or(Detail::Uniform);
        v.array_length = symbol.array_length;
        v.kind = VarKind::Param;
        v.index = static_cast<int>(program_.params.size());
        v.is_output = symbol.is_output;
        v.declared_uniform = symbol.detail == Detail::Uniform;
        v.loc = symbol.loc;
        names_.insert(v.name);
        const VarId id = new_var(std::move(v));
        Param param;
        param.var = id;
        param.init = block([&] { initialise(p, id); });
        program_.params.push_back(std::move(param));
        variables_[&symbol] = id;
    }
    in_init_ = false;
}

// Parameters that are assigned without being output live in local copies.
void Lowering::local_copies() {
    for (const ast::Variable& p : shader_.params) {
        const Symbol& symbol = *p.symbol;
        if (symbol.assigned && !symbol.is_output) {
            const VarId copy = local(symbol.name, symbol.type, symbol.array_length, symbol.loc);
            emit(Op::Copy, copy, {variables_[&symbol]}, symbol.loc);
            variables_[&symbol] = copy;
        }
    }
}

std::string Lowering::unique_name(const std::string& wanted) {
    if (names_.insert(wanted).second) {
        return wanted;
    }
    int& count = name_counts_[wanted];
    count = std::max(count, 1);
    for (;;) {
        std::string name = wanted + "_" + std::to_string(++count);
        if (names_.insert(name).second) {
            return name;
        }
    }
}

VarId Lowering::new_var(Var v) {
    num_values_ += static_cast<std::size_t>(std::max(v.array_length, 1)) *
                   static_cast<std::size_t>(num_components(v.type));
    if (num_values_ > max_values) {
        messages_.error(v.loc, "the shader has too many variables and array elements",
                        base::Code::Limit);
        throw Overflow{};
    }
    program_.vars.push_back(std::move(v));
    return static_cast<VarId>(program_.vars.size() - 1);
}

VarId Lowering::temp(Type type, Loc loc) {
    Var v;
    v.name = unique_name("t" + std::to_string(++num_temps_));
    v.type = type;
    v.kind = VarKind::Temp;
    v.loc = loc;
    return new_var(std::move(v));
}

VarId Lowering::local(const std::string& name, Type type, int array_length, Loc loc) {
    Var v;
    v.name = unique_name(name);
    v.type = type;
    v.array_length = array_length;
    v.kind = VarKind::Local;
    v.loc = loc;
    return new_var(std::move(v));
}

// A new activation of a declared local or formal.
VarId Lowering::local_for(const Symbol& symbol) {
    const VarId id = local(symbol.name, symbol.type, symbol.array_length, symbol.loc);
    program_.vars[static_cast<std::size_t>(id)].declared_uniform = symbol.detail == Detail::Uniform;
    variables_[&symbol] = id;
    return id;
}

VarId Lowering::constant(Type type, std::vector<float> values, int array_length) {
    std::string key = std::to_string(static_cast<int>(type)) + ":" + std::to_string(array_length);
    for (const float x : values) {
        key += "," + std::to_string(std::bit_cast<std::uint32_t>(x)); // -0 and 0 differ
    }
    const auto [it, is_new] = constants_.emplace(std::move(key), no_var);
    if (is_new) {
        Var v;
        v.name = unique_name("k" + std::to_string(++num_constants_));
        v.type = type;
        v.detail = Detail::Uniform;
        v.array_length = array_length;
        v.kind = VarKind::Const;
        v.values = std::move(values);
        it->second = new_var(std::move(v));
    }
    return it->second;
}

VarId Lowering::text(const std::string& value) {
    const auto [it, is_new] = constants_.emplace("s:" + value, no_var);
    if (is_new) {
        Var v;
        v.name = unique_name("k" + std::to_string(++num_constants_));
        v.type = Type::String;
        v.detail = Detail::Uniform;
        v.kind = VarKind::Const;
        v.text = value;
        it->second = new_var(std::move(v));
    }
    return it->second;
}

VarId Lowering::zero(Type type) {
    return type == Type::String
               ? text("")
               : constant(type,
                          std::vector<float>(static_cast<std::size_t>(num_components(type)), 0.0F));
}

Stmt& Lowering::emit(Op op, VarId dst, std::vector<VarId> args, Loc loc) {
    if (++num_statements_ > max_statements) {
        messages_.error(loc,
                        "with all functions inlined the shader has more than " +
                            std::to_string(max_statements) + " statements",
                        base::Code::Limit);
        throw Overflow{};
    }
    Stmt& s = block_->emplace_back();
    s.op = op;
    s.dst = dst;
    s.args = std::move(args);
    s.loc = loc;
    return s;
}

// The variable of a predefined name, without a check of its use.
VarId Lowering::global(int id, Loc loc) {
    VarId& known = globals_[id];
    if (known != no_var) {
        return known;
    }
    const VariableRow& row = variable_rows()[static_cast<std::size_t>(id)];
    const bool hidden = std::any_of(program_.params.begin(), program_.params.end(),
                                    [&](const Param& p) { return var(p.var).name == row.name; });
    Var v;
    v.name = hidden ? unique_name(std::string(row.name) + "_global") : std::string(row.name);
    v.type = row.type;
    v.detail = row.detail;
    v.kind = VarKind::Global;
    v.index = id;
    v.loc = loc;
    known = new_var(std::move(v));
    return known;
}

// L, Cl and Ol exist inside the light statements only (sl.md 3.7).
void Lowering::check_light_variable(int id, Loc loc) {
    if (id != SL_VAR_L && id != SL_VAR_Cl && id != SL_VAR_Ol) {
        return;
    }
    const bool is_light = shader_.type == SL_SHADER_light;
    if (is_light ? id == SL_VAR_L && illuminate_depth_ == 0 : illuminance_depth_ == 0) {
        messages_.warning_once(loc, quoted(variable_rows()[static_cast<std::size_t>(id)].name) +
                                        " has a value only inside " +
                                        (is_light ? "illuminate or solar" : "illuminance"));
    }
}

VarId Lowering::variable(const Symbol& symbol, Loc loc) {
    if (symbol.kind == SymbolKind::Pi) {
        return constant(std::numbers::pi_v<float>);
    }
    if (symbol.kind != SymbolKind::Global) {
        const auto it = variables_.find(&symbol);
        return it != variables_.end() ? it->second
                                      : zero(symbol.type); // an error has been reported
    }
    const VariableRow& row = variable_rows()[static_cast<std::size_t>(symbol.global)];
    if (in_init_) {
        messages_.warning_once(
            loc, "the default of a parameter is evaluated once per instance and cannot use " +
                     quoted(row.name) + "; 0 is used");
        return zero(symbol.type);
    }
    const std::uint32_t bit = shader_type_bit(shader_.type);
    if (((row.readable | row.writable) & bit) == 0) {
        messages_.warning_once(loc, quoted(row.name) + " does not exist in " +
                                        std::string(shader_type_name(shader_.type)) +
                                        " shaders; a local variable of this name, at first 0, is "
                                        "used");
        return copy_of_global(symbol, zero(symbol.type), loc);
    }
    check_light_variable(symbol.global, loc);
    if (symbol.assigned && (row.writable & bit) == 0) {
        return copy_of_global(symbol, global(symbol.global, loc), loc);
    }
    return global(symbol.global, loc);
}

// The local variable that stands for a predefined one; it starts with the value of `source`.
VarId Lowering::copy_of_global(const Symbol& symbol, VarId source, Loc loc) {
    VarId& copy = global_copies_[symbol.global];
    if (copy == no_var) {
        copy = local(symbol.name, symbol.type, 0, loc);
        Stmt s;
        s.op = Op::Copy;
        s.dst = copy;
        s.args = {source};
        s.loc = loc;
        prologue_.push_back(std::move(s));
    }
    return copy;
}

VarId Lowering::assignable(const Symbol& symbol, Loc loc) {
    const VarId id = variable(symbol, loc);
    if (symbol.kind != SymbolKind::Global) {
        return id;
    }
    const VariableRow& row = variable_rows()[static_cast<std::size_t>(symbol.global)];
    if ((row.writable & shader_type_bit(shader_.type)) == 0 &&
        (row.readable & shader_type_bit(shader_.type)) != 0) {
        messages_.warning_once(loc, quoted(row.name) + " is read-only in " +
                                        std::string(shader_type_name(shader_.type)) +
                                        " shaders; a local copy is assigned");
    }
    return id;
}

} // namespace slc
