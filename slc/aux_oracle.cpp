// SPDX-License-Identifier: Apache-2.0
#include "slc/aux_oracle.h"

#include "slc/aux_analysis.h"
#include "slc/ir_util.h"

#include <algorithm>
#include <cmath>

namespace slc {

namespace {

using Path = AuxOracle::Path;

bool is_target(const Stmt& construct, const Stmt& jump) {
    return jump.op == Op::Leave ? construct.op == Op::Scope : is_loop(construct.op);
}

// Keeps the path of the run.
class Tracker : public InterpDirector {
public:
    void enter(const Stmt& s, int body, int round) override {
        path_.push_back({&s, body, round, next_parted_, false});
        next_parted_ = false;
    }
    bool leave() override {
        const bool undo = path_.back().undo;
        path_.pop_back();
        return undo;
    }

protected:
    Path path_;
    bool next_parted_ = false;
};

} // namespace

// The main point: goes its own way, and has its neighbours replayed at operators.
class MainDirector : public Tracker {
public:
    explicit MainDirector(AuxOracle& oracle) : oracle_(oracle) {}
    bool decide(const Stmt& s, int round, bool natural) override {
        path_.push_back({&s, -1, round, false, false});
        oracle_.decisions_[AuxOracle::key(path_, s)] = natural;
        path_.pop_back();
        return natural;
    }
    bool may_jump(const Stmt&) override { return true; }
    bool replace(const Stmt& s, const std::vector<Value>&, Value&) override {
        for (int aux = 1; aux <= 2 && aux_rule(s) == AuxRule::Operator; ++aux) {
            there_[aux - 1] = oracle_.replay(aux, path_, s);
        }
        return false;
    }
    void computed(const Stmt& s, const std::vector<Value>& args, const Value& result) override {
        AuxOracle::Record record{args, result, 0};
        if (builtin_of(s).body == "filterstep") {
            for (const auto& there : there_) {
                record.width += there.size() > 1 ? std::abs(there[1].f() - args[1].f()) : 0;
            }
        }
        oracle_.records_[AuxOracle::key(path_, s)] = record;
    }
    const std::vector<Value>& arguments_at(const Stmt&, int aux) override {
        return there_[aux - 1];
    }

private:
    AuxOracle& oracle_;
    std::vector<Value> there_[2];
};

// A neighbour on its way to where the main point is.
class ReplayDirector : public Tracker {
public:
    ReplayDirector(AuxOracle& oracle, Interpreter& interpreter, const Path& goal,
                   const Stmt* target)
        : oracle_(oracle), interpreter_(interpreter), goal_(goal), target_(target) {}
    [[nodiscard]] const std::vector<Value>& captured() const { return captured_; }

    bool decide(const Stmt& s, int round, bool natural) override {
        path_.push_back({&s, -1, round, false, false});
        const auto known = oracle_.decisions_.find(AuxOracle::key(path_, s));
        path_.pop_back();
        bool taken = natural;
        if (on_the_way(path_.size()) && goal_.size() > path_.size() &&
            goal_[path_.size()].stmt == &s) {
            const AuxOracle::Step& step = goal_[path_.size()];
            taken = s.op == Op::If ? step.body == 0 : round <= step.round;
        }
        next_parted_ =
            s.op == Op::If && (known == oracle_.decisions_.end() || known->second != taken);
        return taken;
    }
    // A jump out of what lies around the operator does not happen; nor does the side of the
    // condition that it stands on.
    bool may_jump(const Stmt& s) override {
        int levels = s.levels;
        std::size_t i = path_.size();
        while (i > 0 && !(is_target(*path_[i - 1].stmt, s) && --levels == 0)) {
            --i;
        }
        if (i == 0 || !on_the_way(i - 1) || goal_.size() < i ||
            goal_[i - 1].stmt != path_[i - 1].stmt) {
            return true;
        }
        const bool same_round = goal_[i - 1].round == path_[i - 1].round;
        if (s.op == Op::Continue && !same_round) {
            return true;
        }
        for (std::size_t k = path_.size(); k-- > i;) {
            if (path_[k].parted) {
                path_[k].undo = true;
                return false;
            }
        }
        return true;
    }
    bool replace(const Stmt& s, const std::vector<Value>& args, Value& result) override {
        if (&s == target_ && path_.size() == goal_.size() && on_the_way(path_.size())) {
            captured_ = args;
            interpreter_.stop();
            return true;
        }
        if (aux_rule(s) == AuxRule::Function || builtin_of(s).has(PropMessage)) {
            return false;
        }
        const auto record = oracle_.records_.find(AuxOracle::key(path_, s));
        if (record != oracle_.records_.end()) {
            result = oracle_.moved(s, record->second, args, interpreter_);
        }
        return true;
    }
    void computed(const Stmt&, const std::vector<Value>&, const Value&) override {}
    const std::vector<Value>& arguments_at(const Stmt&, int) override { return captured_; }

private:
    // The first n steps are those of the goal.
    [[nodiscard]] bool on_the_way(std::size_t n) const {
        return n <= goal_.size() && n <= path_.size() &&
               std::equal(goal_.begin(), goal_.begin() + static_cast<std::ptrdiff_t>(n),
                          path_.begin(),
                          [](const auto& a, const auto& b) { return a.same_place(b); });
    }

    AuxOracle& oracle_;
    Interpreter& interpreter_;
    const Path& goal_;
    const Stmt* target_;
    std::vector<Value> captured_;
};

AuxOracle::AuxOracle(const Program& program, InterpHost& host, Setup setup)
    : program_(program), host_(host), setup_(std::move(setup)),
      main_(std::make_unique<Interpreter>(program, host, 1)) {}

bool AuxOracle::run() {
    MainDirector director(*this);
    setup_(*main_, 0);
    main_->direct(&director);
    const bool ended = main_->run();
    main_->direct(nullptr);
    return ended;
}

std::string AuxOracle::key(const Path& path, const Stmt& s) {
    std::string text;
    for (const Step& step : path) {
        text += std::to_string(reinterpret_cast<std::uintptr_t>(step.stmt)) + "." +
                std::to_string(step.body) + "." + std::to_string(step.round) + "/";
    }
    return text + std::to_string(reinterpret_cast<std::uintptr_t>(&s));
}

std::vector<Value> AuxOracle::replay(int aux, const Path& path, const Stmt& target) {
    Interpreter interpreter(program_, host_, 1);
    setup_(interpreter, aux);
    ReplayDirector director(*this, interpreter, path, &target);
    interpreter.direct(&director);
    interpreter.run();
    return director.captured();
}

Value AuxOracle::at_end(int aux, int variable) {
    Interpreter interpreter(program_, host_, 1);
    setup_(interpreter, aux);
    const Path nowhere;
    ReplayDirector director(*this, interpreter, nowhere, nullptr);
    interpreter.direct(&director);
    interpreter.run();
    return interpreter.global(variable, 0);
}

// Derivatives are the same there, normals turn with the surface, steps keep their width.
Value AuxOracle::moved(const Stmt& s, const Record& record, const std::vector<Value>& args,
                       const Interpreter& there) const {
    const std::string_view name = builtin_of(s).name;
    Value result = record.result;
    if (name == "calculatenormal") {
        const Triple3 n = record.result.triple();
        const double length = std::sqrt(dot3(n, n));
        const Triple3 from = main_->global(SL_VAR_Ng, 0).triple();
        const Triple3 to = there.global(SL_VAR_Ng, 0).triple();
        for (std::size_t k = 0; k < 3; ++k) {
            result.x[k] = n[k] + length * (to[k] - from[k]);
        }
    } else if (builtin_of(s).body == "filterstep") {
        const double edge = args[0].f(), x = args[1].f(), w = record.width;
        result = Value(w > 0 ? std::clamp((x + w / 2 - edge) / w, 0.0, 1.0) : x < edge ? 0.0 : 1.0);
    }
    return result;
}

} // namespace slc
