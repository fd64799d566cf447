// SPDX-License-Identifier: Apache-2.0
// Uniform or varying (sl.md 2.3): locals and temporaries start uniform and become varying when they
// are given a varying value, or are assigned where not all points go the same way.
//   var x local varying float          var x local uniform float
//   x = add Kd k1                 ->   x = add Kd k1
// "All points" are those that entered the variable's home: the innermost block with all its uses,
// if its first use there sets it. So the counter of an inlined loop stays uniform even where only
// some points call the function. A variable declared uniform that gets a varying value becomes
// varying too, with a warning: each point keeps its own value (sl.md 2.2), and results do not
// depend on which points share a packet (slc-004). Needs: nothing. Provides: Var::detail. Spoils:
// nothing.
#include "slc/ir_util.h"
#include "slc/passes.h"

#include <algorithm>
#include <cctype>
#include <unordered_set>

namespace slc {

namespace {

// The home of each local, as the number of blocks around it: 0 is the body of the shader.
class Homes {
public:
    explicit Homes(const Program& program) : uses_(program.vars.size()) { visit(program.body); }
    [[nodiscard]] std::size_t depth(VarId id) const {
        const Uses& u = uses_[static_cast<std::size_t>(id)];
        const bool starts_there = u.set_first && u.common.size() == u.first_depth;
        return starts_there && !u.common.empty() ? u.common.size() - 1 : 0;
    }

private:
    struct Uses {
        bool seen = false;
        bool set_first = false; // the first use assigns all of it
        std::size_t first_depth = 0;
        std::vector<const Block*> common; // blocks that hold all uses, outermost first
    };
    void visit(const Block& b);
    void use(VarId id, bool sets);

    std::vector<Uses> uses_;
    std::vector<const Block*> path_;
};

void Homes::use(VarId id, bool sets) {
    Uses& u = uses_[static_cast<std::size_t>(id)];
    if (!u.seen) {
        u = {true, sets, path_.size(), path_};
        return;
    }
    std::size_t n = 0;
    while (n < u.common.size() && n < path_.size() && u.common[n] == path_[n]) {
        ++n;
    }
    u.common.resize(n);
}

void Homes::visit(const Block& b) {
    path_.push_back(&b);
    for (const Stmt& s : b) {
        const bool is_loop_test = s.op == Op::Loop; // reads its condition after bodies[0]
        if (!is_loop_test) {
            for_each_read(s, [&](VarId id) { use(id, false); });
        }
        for_each_write(s, [&](VarId id, bool whole) { use(id, whole); });
        for (const Block& inner : s.bodies) {
            visit(inner);
        }
        if (is_loop_test) {
            for_each_read(s, [&](VarId id) { use(id, false); });
        }
    }
    path_.pop_back();
}

class DetailInference {
public:
    DetailInference(Program& program, Messages* messages)
        : program_(program), messages_(messages), homes_(program) {}
    void run();

private:
    // One step from a block into a block of one of its statements.
    struct Step {
        const Stmt* stmt;
        bool is_loop, is_scope;
        bool partial; // not all points that are in the outer block are here, or still here
    };
    void block(const Block& b);
    void statement(const Stmt& s);
    void inside(const Stmt& s, const Block& b, bool partial);
    void loop(const Stmt& s);
    void jump(const Stmt& s);
    void assign(const Stmt& s);
    void raise(VarId id, const Stmt& s, bool by_message);
    [[nodiscard]] bool varying_value(const Stmt& s) const;
    [[nodiscard]] bool varying_control(std::size_t home) const;
    [[nodiscard]] bool is_varying(VarId id) const { return var(id).detail == Detail::Varying; }
    [[nodiscard]] const Var& var(VarId id) const {
        return program_.vars[static_cast<std::size_t>(id)];
    }
    void warn(VarId id, Loc loc);
    [[nodiscard]] std::string source_name(const Var& v) const;

    Program& program_;
    Messages* messages_;
    Homes homes_;
    bool changed_ = false;
    std::vector<Step> steps_;
    std::unordered_set<const Stmt*> divergent_loops_; // some points leave before others
};

void DetailInference::run() {
    for (Var& v : program_.vars) {
        if (v.kind == VarKind::Local || v.kind == VarKind::Temp) {
            v.detail = Detail::Uniform;
        }
    }
    do {
        changed_ = false;
        block(program_.body);
    } while (changed_);
}

bool DetailInference::varying_control(std::size_t home) const {
    return std::any_of(steps_.begin() + static_cast<std::ptrdiff_t>(std::min(home, steps_.size())),
                       steps_.end(), [](const Step& f) { return f.partial; });
}

void DetailInference::block(const Block& b) {
    for (const Stmt& s : b) {
        statement(s);
    }
}

void DetailInference::inside(const Stmt& s, const Block& b, bool partial) {
    steps_.push_back({&s, is_loop(s.op), s.op == Op::Scope, partial});
    block(b);
    steps_.pop_back();
}

void DetailInference::statement(const Stmt& s) {
    switch (s.op) {
    case Op::If:
        inside(s, s.bodies[0], is_varying(s.args[0]));
        inside(s, s.bodies[1], is_varying(s.args[0]));
        break;
    case Op::Loop:
        loop(s);
        break;
    case Op::Scope:
    case Op::Solar:
        inside(s, s.bodies[0], false);
        break;
    case Op::Illuminate:
        inside(s, s.bodies[0], s.args.size() > 1);
        break;
    case Op::Illuminance: // lights reach some points and not others
        assign(s);
        for (const Block& b : s.bodies) {
            inside(s, b, true);
        }
        break;
    case Op::Break:
    case Op::Continue:
    case Op::Leave:
        jump(s);
        break;
    default:
        assign(s);
        break;
    }
}

void DetailInference::loop(const Stmt& s) {
    inside(s, s.bodies[0], divergent_loops_.contains(&s));
    if (is_varying(s.args[0]) && divergent_loops_.insert(&s).second) {
        changed_ = true;
    }
    inside(s, s.bodies[1],
           divergent_loops_.contains(&s)); // a varying continue is undone at the step
    inside(s, s.bodies[2], divergent_loops_.contains(&s));
}

// A jump some points take and others do not: what it leaves goes on with fewer points.
void DetailInference::jump(const Stmt& s) {
    const bool to_scope = s.op == Op::Leave;
    int levels = s.levels;
    bool partial = false;
    for (auto step = steps_.rbegin(); step != steps_.rend() && levels > 0; ++step) {
        partial = partial || step->partial;
        levels -= (to_scope ? step->is_scope : step->is_loop) ? 1 : 0;
        if (!partial) {
            continue;
        }
        step->partial = true;
        const bool leaves_loop = step->is_loop && !(levels == 0 && s.op == Op::Continue);
        if (leaves_loop && step->stmt->op == Op::Loop) {
            changed_ = divergent_loops_.insert(step->stmt).second || changed_;
        }
    }
}

bool DetailInference::varying_value(const Stmt& s) const {
    bool varying = false;
    for_each_read(s, [&](VarId id) { varying = varying || is_varying(id); });
    if (s.op != Op::Call) {
        return varying;
    }
    const BuiltinRow& row = builtin_of(s);
    if (row.has(PropRandom)) { // one value for a uniform target (sl.md 4.1.3)
        return s.dst == no_var || !var(s.dst).declared_uniform;
    }
    // The footprint du, dv does not make the lookup of a uniform place varying.
    const std::uint64_t state = row.reads & ~(1ull << SL_VAR_du | 1ull << SL_VAR_dv);
    bool reads_varying = row.has(PropVaries) || row.has(PropSpaces);
    for (int i = 0; i < SL_VAR_COUNT; ++i) {
        reads_varying = reads_varying ||
                        ((state >> i & 1) != 0 &&
                         variable_rows()[static_cast<std::size_t>(i)].detail == Detail::Varying);
    }
    return varying || reads_varying;
}

void DetailInference::assign(const Stmt& s) {
    const bool varying = varying_value(s) || (is_loop(s.op) && !s.options.empty());
    const bool by_message = is_loop(s.op) || (s.op == Op::Call && builtin_of(s).has(PropMessage));
    for_each_write(s, [&](VarId id, bool) {
        // Temporaries are read only where they were made.
        const bool partial = var(id).kind == VarKind::Local  ? varying_control(homes_.depth(id))
                             : var(id).kind == VarKind::Temp ? false
                                                             : varying_control(0);
        if (varying || partial) {
            raise(id, s, by_message);
        }
    });
}

void DetailInference::raise(VarId id, const Stmt& s, bool by_message) {
    Var& v = program_.vars[static_cast<std::size_t>(id)];
    if (v.detail == Detail::Varying || v.kind == VarKind::Const || v.kind == VarKind::Global) {
        return;
    }
    v.detail = Detail::Varying;
    changed_ = true;
    const bool expected =
        v.kind == VarKind::Temp || (v.kind == VarKind::Local && !v.declared_uniform);
    if (!expected && !by_message) {
        warn(id, s.loc);
    }
}

// Inlined copies have names of their own; the source tells what the user called the variable.
std::string DetailInference::source_name(const Var& v) const {
    const std::string_view line = messages_->sources().line(v.loc.file, v.loc.line);
    const std::size_t start = v.loc.col - 1;
    std::size_t end = start;
    while (end < line.size() &&
           (std::isalnum(static_cast<unsigned char>(line[end])) != 0 || line[end] == '_')) {
        ++end;
    }
    const std::string_view name =
        end > start ? line.substr(start, end - start) : std::string_view();
    return std::string(!name.empty() && v.name.starts_with(name) ? name : std::string_view(v.name));
}

void DetailInference::warn(VarId id, Loc loc) {
    if (messages_ == nullptr) {
        return;
    }
    const Var& v = var(id);
    const bool is_param = v.kind == VarKind::Param;
    messages_->warning_once(loc,
                            std::string(is_param ? "uniform parameter " : "uniform variable ") +
                                quoted(source_name(v)) +
                                " is assigned a varying value, or where points take different "
                                "ways; it becomes varying" +
                                (is_param && !v.declared_uniform
                                     ? " (parameters are uniform unless declared varying)"
                                     : ""));
}

} // namespace

void pass_detail(Program& program, Messages* messages) {
    DetailInference(program, messages).run();
}

} // namespace slc
