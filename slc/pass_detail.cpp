// SPDX-License-Identifier: Apache-2.0
// Uniform or varying (sl.md 2.3): locals and temporaries start uniform and become varying when they
// are given a varying value, or are assigned where not all points go the same way.
//   var x local varying float          var x local uniform float
//   x = add Kd k1                 ->   x = add Kd k1
// A variable declared uniform that gets a varying value becomes varying too, with a warning: the
// value of the "current point" (sl.md 2.2), and results do not depend on which points share a
// packet (slc-004). Needs: nothing. Provides: Var::detail. Spoils: nothing.
#include "slc/ir_util.h"
#include "slc/passes.h"

#include <algorithm>
#include <unordered_set>

namespace slc {

namespace {

class DetailInference {
public:
    DetailInference(Program& program, Messages* messages)
        : program_(program), messages_(messages) {}
    void run();

private:
    // Loop or Scope around the current statement.
    struct Frame {
        const Stmt* stmt;
        bool is_loop;
        bool diverged; // some points have left: what follows inside is under varying control
        bool skipping; // some points wait for the step after a varying continue
    };
    void block(const Block& b);
    void statement(const Stmt& s);
    void bodies(const Stmt& s, bool varying_body);
    void loop(const Stmt& s);
    void jump(const Stmt& s);
    void assign(const Stmt& s);
    void raise(VarId id, const Stmt& s, bool by_message);
    [[nodiscard]] bool varying_value(const Stmt& s) const;
    [[nodiscard]] bool varying_control() const;
    [[nodiscard]] bool is_varying(VarId id) const { return var(id).detail == Detail::Varying; }
    [[nodiscard]] const Var& var(VarId id) const {
        return program_.vars[static_cast<std::size_t>(id)];
    }
    void warn(VarId id, Loc loc);

    Program& program_;
    Messages* messages_;
    bool varying_ = false;
    bool changed_ = false;
    std::vector<Frame> frames_;
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

bool DetailInference::varying_control() const {
    return varying_ || std::any_of(frames_.begin(), frames_.end(),
                                   [](const Frame& f) { return f.diverged || f.skipping; });
}

void DetailInference::block(const Block& b) {
    for (const Stmt& s : b) {
        statement(s);
    }
}

void DetailInference::statement(const Stmt& s) {
    switch (s.op) {
    case Op::If:
        bodies(s, is_varying(s.args[0]));
        break;
    case Op::Loop:
        loop(s);
        break;
    case Op::Scope:
        frames_.push_back({&s, false, false, false});
        block(s.bodies[0]);
        frames_.pop_back();
        break;
    case Op::Illuminance:
    case Op::Gather: // lights and rays reach some points and not others
        assign(s);
        frames_.push_back({&s, true, false, false});
        bodies(s, true);
        frames_.pop_back();
        break;
    case Op::Illuminate:
        bodies(s, s.args.size() > 1);
        break;
    case Op::Solar:
        bodies(s, false);
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

void DetailInference::bodies(const Stmt& s, bool varying_body) {
    const bool outer = varying_;
    varying_ = varying_ || varying_body;
    for (const Block& b : s.bodies) {
        block(b);
    }
    varying_ = outer;
}

void DetailInference::loop(const Stmt& s) {
    frames_.push_back({&s, true, divergent_loops_.contains(&s), false});
    block(s.bodies[0]);
    if (is_varying(s.args[0]) && divergent_loops_.insert(&s).second) {
        changed_ = true;
    }
    frames_.back().diverged = divergent_loops_.contains(&s);
    block(s.bodies[1]);
    frames_.back().skipping = false; // points that continue join again
    block(s.bodies[2]);
    frames_.pop_back();
}

// A jump some points take and others do not: every loop it leaves goes on with fewer points.
void DetailInference::jump(const Stmt& s) {
    if (!varying_control()) {
        return;
    }
    int levels = s.levels;
    for (auto f = frames_.rbegin(); f != frames_.rend() && levels > 0; ++f) {
        if (f->is_loop == (s.op != Op::Leave)) {
            --levels;
        }
        const bool is_target = levels == 0;
        if (is_target && s.op == Op::Continue) {
            f->skipping = true;
        } else if (f->is_loop) {
            f->diverged = true;
            changed_ = divergent_loops_.insert(f->stmt).second || changed_;
        } else if (is_target) {
            f->diverged = true;
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
    const bool control = varying_control();
    const bool by_message = is_loop(s.op) || (s.op == Op::Call && builtin_of(s).has(PropMessage));
    for_each_write(s, [&](VarId id, bool) {
        if (varying || (control && var(id).kind != VarKind::Temp)) {
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

void DetailInference::warn(VarId id, Loc loc) {
    if (messages_ == nullptr) {
        return;
    }
    const Var& v = var(id);
    const bool is_param = v.kind == VarKind::Param;
    messages_->warning_once(
        loc,
        std::string(is_param ? "uniform parameter " : "uniform variable ") + quoted(v.name) +
            " is assigned a varying value, or where points take different ways; it becomes "
            "varying" +
            (is_param && !v.declared_uniform ? " (parameters are uniform unless declared varying)"
                                             : ""));
}

} // namespace

void pass_detail(Program& program, Messages* messages) {
    DetailInference(program, messages).run();
}

} // namespace slc
