// SPDX-License-Identifier: Apache-2.0
// Test helper: area operators by record and replay, apart from everything the compiler does about
// them. In: a program with its operators in place, and what its variables are at a point and at the
// two auxiliary points. Each point runs on its own on the interpreter, in double. At every operator
// the main point comes to, the neighbours are replayed up to there: by their own decisions, but
// into the constructs around the operator, as if they had come there (sl.md 6.3, 6.4).
#pragma once

#include "slc/interp.h"

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace slc {

class AuxOracle {
public:
    // Sets variables and parameters of an interpreter with one point: 0 the main one, 1 and 2 the
    // auxiliary ones.
    using Setup = std::function<void(Interpreter& interpreter, int aux)>;
    AuxOracle(const Program& program, InterpHost& host, Setup setup);
    // Runs the main point; false if it does not end.
    bool run();
    [[nodiscard]] Interpreter& main() { return *main_; }
    // Runs an auxiliary point to its end: what displacement shaders hand on.
    [[nodiscard]] Value at_end(int aux, int variable);

    struct Step {
        const Stmt* stmt;
        int body, round;
        bool parted; // the main point went elsewhere, or was not here
        bool undo;
        [[nodiscard]] bool same_place(const Step& s) const {
            return stmt == s.stmt && body == s.body && round == s.round;
        }
    };
    using Path = std::vector<Step>;

private:
    friend class MainDirector;
    friend class ReplayDirector;
    struct Record { // of a call at one place of the main run
        std::vector<Value> args;
        Value result;
        double width = 0; // of a filtered step
    };
    [[nodiscard]] static std::string key(const Path& path, const Stmt& s);
    [[nodiscard]] std::vector<Value> replay(int aux, const Path& path, const Stmt& target);
    // The operator's value at an auxiliary point, given the main one's.
    [[nodiscard]] Value moved(const Stmt& s, const Record& record, const std::vector<Value>& args,
                              const Interpreter& there) const;

    const Program& program_;
    InterpHost& host_;
    Setup setup_;
    std::unique_ptr<Interpreter> main_;
    std::map<std::string, bool> decisions_;
    std::map<std::string, Record> records_;
};

} // namespace slc
