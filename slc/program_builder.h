// SPDX-License-Identifier: Apache-2.0
// Programs written by hand, for tests of what comes after the front end.
#pragma once

#include "slc/builtins.h"
#include "slc/ir.h"

#include <initializer_list>
#include <string>
#include <vector>

namespace slc {

class ProgramBuilder {
public:
    explicit ProgramBuilder(std::string name, sl_shader_type type = SL_SHADER_surface) {
        program.name = std::move(name);
        program.shader_type = type;
        program.files = {"hand.sl"};
    }

    VarId add(Var v) {
        program.vars.push_back(std::move(v));
        return static_cast<VarId>(program.vars.size()) - 1;
    }
    VarId constant(std::vector<float> values, Type type = Type::Float, int array_length = 0) {
        Var v;
        v.name = "c" + std::to_string(program.vars.size());
        v.type = type;
        v.detail = Detail::Uniform;
        v.kind = VarKind::Const;
        v.values = std::move(values);
        v.array_length = array_length;
        return add(v);
    }
    VarId constant(float value) { return constant(std::vector<float>{value}); }
    VarId text(const std::string& value) {
        const VarId v = constant(std::vector<float>{}, Type::String);
        program.vars[static_cast<std::size_t>(v)].text = value;
        return v;
    }
    VarId global(sl_variable id) {
        const VariableRow& row = variable_rows()[id];
        Var v;
        v.name = row.name;
        v.type = row.type;
        v.detail = row.detail;
        v.kind = VarKind::Global;
        v.index = id;
        return add(v);
    }
    VarId variable(const std::string& name, Type type, Detail detail, int array_length = 0,
                   VarKind kind = VarKind::Local) {
        Var v;
        v.name = name;
        v.type = type;
        v.detail = detail;
        v.array_length = array_length;
        v.kind = kind;
        return add(v);
    }
    VarId temp(Type type = Type::Float, Detail detail = Detail::Varying) {
        return variable("t" + std::to_string(++num_temps_), type, detail, 0, VarKind::Temp);
    }
    VarId param(const std::string& name, Type type, Detail detail, VarId value,
                bool is_output = false, int array_length = 0) {
        const VarId v = variable(name, type, detail, array_length, VarKind::Param);
        program.vars[static_cast<std::size_t>(v)].index = static_cast<int>(program.params.size());
        program.vars[static_cast<std::size_t>(v)].is_output = is_output;
        program.params.push_back({v, {statement(Op::Copy, v, {value})}});
        return v;
    }

    Stmt statement(Op op, VarId dst, std::vector<VarId> args = {}) {
        Stmt s;
        s.op = op;
        s.dst = dst;
        s.args = std::move(args);
        s.loc = {0, ++line_, 1};
        return s;
    }
    // A statement with a fresh temporary as its result.
    VarId value(Block& b, Op op, std::vector<VarId> args, Type type = Type::Float,
                Detail detail = Detail::Varying) {
        const VarId t = temp(type, detail);
        b.push_back(statement(op, t, std::move(args)));
        return t;
    }
    // By body name, because overloads share names.
    static int row(std::string_view body) {
        for (std::size_t i = 0; i < builtin_rows().size(); ++i) {
            if (builtin_rows()[i].body == body) {
                return static_cast<int>(i);
            }
        }
        return -1;
    }
    Stmt call(std::string_view body, VarId dst, std::vector<VarId> args) {
        Stmt s = statement(Op::Call, dst, std::move(args));
        s.builtin = row(body);
        return s;
    }
    Stmt with_bodies(Stmt s, std::vector<Block> bodies) {
        s.bodies = std::move(bodies);
        return s;
    }

    Program program;

private:
    int num_temps_ = 0;
    std::uint32_t line_ = 0;
};

} // namespace slc
