// SPDX-License-Identifier: Apache-2.0
#include "slc/specialise.h"

#include "slc/compiler.h"
#include "slc/ir_text.h"
#include "slc/ir_util.h"

#include <algorithm>
#include <set>

namespace slc {

namespace {

std::optional<Program> sound_program(std::string_view ir, std::string& error) {
    std::optional<Program> program = parse_ir(ir, error);
    if (!program) {
        return std::nullopt;
    }
    const std::vector<std::string> complaints = verify_ir(*program);
    if (!complaints.empty()) {
        error = complaints.front();
        return std::nullopt;
    }
    return program;
}

void note_written(const Block& b, std::vector<bool>& written) {
    for (const Stmt& s : b) {
        for_each_write(s, [&](VarId id, bool) { written[static_cast<std::size_t>(id)] = true; });
        for (const Block& inner : s.bodies) {
            note_written(inner, written);
        }
    }
}

std::size_t count_statements(const Block& b) {
    std::size_t n = b.size();
    for (const Stmt& s : b) {
        for (const Block& inner : s.bodies) {
            n += count_statements(inner);
        }
    }
    return n;
}

bool fits(const Var& param, const ConstantParam& value) {
    if (param.type == Type::String) {
        return param.array_length == 0 && value.floats.empty();
    }
    const auto size = static_cast<std::size_t>(std::max(param.array_length, 1)) *
                      static_cast<std::size_t>(num_components(param.type));
    return value.floats.size() == size;
}

class Specialiser {
public:
    explicit Specialiser(Program& program) : program_(program), written_(program.vars.size()) {
        note_written(program.body, written_);
        for (const Var& v : program.vars) {
            names_.insert(v.name);
        }
    }

    void run(std::span<const ConstantParam> constants) {
        std::vector<VarId> to(program_.vars.size());
        for (std::size_t i = 0; i < to.size(); ++i) {
            to[i] = static_cast<VarId>(i);
        }
        for (const Param& p : program_.params) {
            const Var& v = program_.vars[static_cast<std::size_t>(p.var)];
            const auto it = std::find_if(constants.begin(), constants.end(),
                                         [&](const ConstantParam& c) { return c.name == v.name; });
            if (it != constants.end() && !v.is_output && fits(v, *it)) {
                to[static_cast<std::size_t>(p.var)] = add_constant(p.var, *it);
            }
        }
        renumber(program_.body, to);
        copy_changed();
        for (Param& p : program_.params) {
            p.init.clear(); // the block comes from the instance of the general shader
        }
    }

private:
    VarId add(Var v, const std::string& stem) {
        v.name = stem;
        for (int n = 2; !names_.insert(v.name).second; ++n) {
            v.name = stem + "_" + std::to_string(n);
        }
        program_.vars.push_back(std::move(v));
        return static_cast<VarId>(program_.vars.size() - 1);
    }

    // A constant; for a parameter the shader assigns to, a local that starts with its value.
    VarId add_constant(VarId param, const ConstantParam& value) {
        Var v = program_.vars[static_cast<std::size_t>(param)];
        const std::string name = v.name;
        v.index = -1;
        v.is_output = v.declared_uniform = false;
        Var local = v;
        v.kind = VarKind::Const;
        v.detail = Detail::Uniform;
        v.values = value.floats;
        v.text = value.text;
        const VarId constant = add(std::move(v), name + "_is");
        if (!written_[static_cast<std::size_t>(param)]) {
            return constant;
        }
        local.kind = VarKind::Local;
        const VarId changed = add(std::move(local), name + "_own");
        first_.push_back({changed, constant});
        return changed;
    }

    void copy_changed() {
        Block head;
        for (const auto& [local, constant] : first_) {
            Stmt s;
            s.op = Op::Copy;
            s.dst = local;
            s.args = {constant};
            head.push_back(std::move(s));
        }
        program_.body.insert(program_.body.begin(), std::make_move_iterator(head.begin()),
                             std::make_move_iterator(head.end()));
    }

    Program& program_;
    std::vector<bool> written_;
    std::set<std::string> names_;
    std::vector<std::pair<VarId, VarId>> first_;
};

} // namespace

std::optional<Specialised> specialise(std::string_view ir, std::span<const ConstantParam> constants,
                                      std::string& error) {
    std::optional<Program> program = sound_program(ir, error);
    if (!program) {
        return std::nullopt;
    }
    Specialised result;
    Specialiser(*program).run(constants);
    CompileOptions options;
    options.exact = true;
    run_passes(*program, options);
    result.num_statements = count_statements(program->body);
    result.program = std::move(*program);
    return result;
}

} // namespace slc
