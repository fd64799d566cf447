// SPDX-License-Identifier: Apache-2.0
// Random programs of nested control flow, emitted against interpreted. Programs are written as
// lowering leaves them (all varying) and go through the passes, so the inference of uniform values
// and the emitter's masks meet every mixture of loops, exits over several levels, early returns and
// lights. Values are small integers: exact in float and double.
#include "slc/ir_text.h"
#include "slc/oracle_compare.h"
#include "slc/program_builder.h"

#include <gtest/gtest.h>
#include <random>

namespace slc {
namespace {

constexpr int num_locals = 5;
constexpr int max_depth = 4;

class Generator {
public:
    explicit Generator(unsigned seed) : random_(seed), builder_("random") {
        const VarId zero = builder_.constant(0);
        // Varying input with integers from it, and two uniform ones.
        const VarId input = builder_.param("input", Type::Float, Detail::Varying, zero);
        Block& body = builder_.program.body;
        const VarId scaled = builder_.value(body, Op::Mul, {input, builder_.constant(4)});
        input_ = local("whole");
        body.push_back(builder_.call("floor", input_, {scaled}));
        uniform_ =
            builder_.param("uniform_input", Type::Float, Detail::Uniform, builder_.constant(2));
        P_ = builder_.global(SL_VAR_P);
        for (int i = 0; i < num_locals; ++i) {
            locals_.push_back(local("x" + std::to_string(i)));
            body.push_back(builder_.statement(Op::Copy, locals_.back(), {operand()}));
        }
        fill(body, 0);
        for (int i = 0; i < num_locals; ++i) {
            const VarId out = builder_.param("out_x" + std::to_string(i), Type::Float,
                                             Detail::Varying, zero, true);
            body.push_back(
                builder_.statement(Op::Copy, out, {locals_[static_cast<std::size_t>(i)]}));
        }
    }

    Program& program() { return builder_.program; }

private:
    int pick(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }

    VarId local(const std::string& name) {
        return builder_.variable(name, Type::Float, Detail::Varying);
    }

    VarId operand() {
        switch (pick(6)) {
        case 0:
            return builder_.constant(static_cast<float>(pick(5) - 2));
        case 1:
            return input_;
        case 2:
            return uniform_;
        default:
            return locals_.empty()
                       ? input_
                       : locals_[static_cast<std::size_t>(pick(static_cast<int>(locals_.size())))];
        }
    }

    VarId condition(Block& b) {
        static constexpr Op relations[] = {Op::Eq, Op::Ne, Op::Lt, Op::Le, Op::Gt, Op::Ge};
        // Uniform now and then, so that plain C control meets masks.
        const VarId left = pick(3) == 0 ? uniform_ : operand();
        const VarId right = builder_.constant(static_cast<float>(pick(5) - 1));
        const VarId c = builder_.value(b, relations[pick(6)], {left, right});
        if (pick(4) == 0) {
            const VarId d = builder_.value(b, relations[pick(6)], {operand(), operand()});
            return builder_.value(b, pick(2) == 0 ? Op::And : Op::Or, {c, d});
        }
        return pick(6) == 0 ? builder_.value(b, Op::Not, {c}) : c;
    }

    // Sums are clamped so that values stay small.
    void assign(Block& b) {
        const VarId to = locals_[static_cast<std::size_t>(pick(num_locals))];
        const VarId sum =
            builder_.value(b, pick(2) == 0 ? Op::Add : Op::Sub, {operand(), operand()});
        if (pick(4) == 0) {
            b.push_back(builder_.statement(Op::Select, to, {condition(b), sum, operand()}));
            return;
        }
        b.push_back(
            builder_.call("clamp_f", to, {sum, builder_.constant(-20), builder_.constant(20)}));
    }

    void fill(Block& b, int depth) {
        const int n = 2 + pick(3);
        for (int i = 0; i < n; ++i) {
            statement(b, depth);
        }
    }

    void statement(Block& b, int depth) {
        const int kind = depth >= max_depth ? 0 : pick(10);
        if (kind <= 3) {
            assign(b);
        } else if (kind <= 6) {
            branch(b, depth);
        } else if (kind == 7) {
            loop(b, depth);
        } else if (kind == 8) {
            scope(b, depth);
        } else {
            lights(b, depth);
        }
    }

    void branch(Block& b, int depth) {
        const VarId c = condition(b);
        Block yes, no;
        fill(yes, depth + 1);
        if (pick(3) == 0) {
            leave(yes);
        }
        if (pick(2) == 0) {
            fill(no, depth + 1);
        }
        b.push_back(builder_.with_bodies(builder_.statement(Op::If, no_var, {c}), {yes, no}));
    }

    // An exit to one of the constructs around, if there is one.
    void leave(Block& b) {
        const bool from_scope = num_scopes_ > 0 && (num_loops_ == 0 || pick(3) == 0);
        if (!from_scope && num_loops_ == 0) {
            return;
        }
        Stmt s = builder_.statement(from_scope     ? Op::Leave
                                    : pick(2) == 0 ? Op::Break
                                                   : Op::Continue,
                                    no_var);
        s.levels = 1 + pick(from_scope ? num_scopes_ : num_loops_);
        b.push_back(s);
    }

    void loop(Block& b, int depth) {
        const VarId i = local("i" + std::to_string(++num_names_));
        b.push_back(builder_.statement(Op::Copy, i, {builder_.constant(0)}));
        Block test, body;
        const VarId bound = pick(2) == 0 ? builder_.constant(3) : input_;
        const VarId more = builder_.value(test, Op::Lt, {i, bound});
        ++num_loops_;
        fill(body, depth + 1);
        --num_loops_;
        const Block step{builder_.statement(Op::Add, i, {i, builder_.constant(1)})};
        b.push_back(
            builder_.with_bodies(builder_.statement(Op::Loop, no_var, {more}), {test, body, step}));
    }

    void scope(Block& b, int depth) {
        Block body;
        ++num_scopes_;
        fill(body, depth + 1);
        leave(body);
        --num_scopes_;
        b.push_back(builder_.with_bodies(builder_.statement(Op::Scope, no_var), {body}));
    }

    void lights(Block& b, int depth) {
        if (in_lights_) {
            return assign(b); // light loops do not nest (sl.md 5.5)
        }
        Block body;
        in_lights_ = true;
        ++num_loops_;
        fill(body, depth + 1);
        --num_loops_;
        in_lights_ = false;
        b.push_back(
            builder_.with_bodies(builder_.statement(Op::Illuminance, no_var, {P_}), {body}));
    }

    std::mt19937 random_;
    ProgramBuilder builder_;
    VarId input_ = no_var;
    VarId uniform_ = no_var;
    VarId P_ = no_var;
    std::vector<VarId> locals_;
    int num_loops_ = 0;
    int num_scopes_ = 0;
    int num_names_ = 0;
    bool in_lights_ = false;
};

class Random : public ::testing::TestWithParam<BuildWay> {};

TEST_P(Random, ControlFlow) {
    int num_compared = 0;
    const char* first = std::getenv("SLC_RANDOM_SEED"); // to look further, by hand
    const unsigned start = first ? static_cast<unsigned>(std::strtoul(first, nullptr, 10)) : 1;
    for (unsigned seed = start; seed < start + 24; ++seed) {
        Generator generator(seed);
        Program& program = generator.program();
        run_passes(program, {});
        const std::vector<std::string> broken = verify_ir(program);
        ASSERT_TRUE(broken.empty()) << "seed " << seed << ": " << broken.front();
        Comparison comparison(program, GetParam());
        ASSERT_TRUE(comparison.built()) << "seed " << seed;
        for (const std::uint32_t n : {7U, 64U}) {
            const std::string difference = comparison.run(n);
            ASSERT_EQ(difference, "") << "seed " << seed << ", batch of " << n << "\n"
                                      << print_ir(program) << comparison.text();
        }
        ++num_compared;
    }
    EXPECT_EQ(num_compared, 24);
}

std::string way_name(const ::testing::TestParamInfo<BuildWay>& info) {
    return "Lanes" + std::to_string(info.param.lanes) + "O" +
           std::to_string(info.param.optimisation);
}

INSTANTIATE_TEST_SUITE_P(Ways, Random,
                         ::testing::ValuesIn(std::vector<BuildWay>{{native_lanes(), 1}, {4, 0}}),
                         way_name);

} // namespace
} // namespace slc
