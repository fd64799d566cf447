// SPDX-License-Identifier: Apache-2.0
// Every operation and every form of control flow of the IR, on both widths, unoptimised and
// optimised, in batches of 1, 7, 64 and 256 points, against values computed here point by point.
// Operations are exact or correctly rounded, and the emitted code is compiled without contraction,
// so results are compared bit for bit.
#include "slc/emit_runner.h"
#include "slc/program_builder.h"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>

namespace slc {
namespace {

constexpr std::uint32_t batch_sizes[] = {1, 7, 64, 256};

// One point's inputs; the program sees them as varying parameters.
struct Point {
    float a, b;
    float p[3], q[3];
    float m[16];
};

Point point_at(std::uint32_t i) {
    Point x{};
    const auto f = static_cast<float>(i);
    x.a = static_cast<float>(i % 7) - 3;         // -3 .. 3
    x.b = 0.25F * static_cast<float>(i % 5) + 1; // 1 .. 2
    for (int k = 0; k < 3; ++k) {
        x.p[k] = std::sin(f + static_cast<float>(k));
        x.q[k] = i % 3 == 0 ? x.p[k] : static_cast<float>(k) - 0.5F * f;
    }
    for (int k = 0; k < 16; ++k) {
        x.m[k] = (k % 5 == 0 ? 4.0F : 0.0F) +
                 0.125F * static_cast<float>((i + static_cast<unsigned>(k)) % 8);
    }
    return x;
}

constexpr float uniform_u = 3;

// What a case builds with, and its statements.
struct Setting {
    ProgramBuilder& builder;
    Block& block;
    VarId a, b, p, q, m, u, up; // u, up: uniform

    VarId value(Op op, std::vector<VarId> args, Type type = Type::Float,
                Detail detail = Detail::Varying) const {
        return builder.value(block, op, std::move(args), type, detail);
    }
    VarId local(const std::string& name, Type type = Type::Float, Detail detail = Detail::Varying,
                int array_length = 0) const {
        return builder.variable(name, type, detail, array_length);
    }
    void set(VarId v, VarId from) const { block.push_back(builder.statement(Op::Copy, v, {from})); }
};

struct Case {
    std::string name;
    Type type;
    std::function<VarId(const Setting&)> build;
    std::function<void(const Point&, float*)> expect;
};

using F1 = std::function<float(const Point&)>;

Case float_case(const std::string& name, std::function<VarId(const Setting&)> build, F1 expect) {
    return {name, Type::Float, std::move(build),
            [expect](const Point& x, float* out) { out[0] = expect(x); }};
}

Case triple_case(const std::string& name, std::function<VarId(const Setting&)> build,
                 std::function<float(const Point&, int)> expect) {
    return {name, Type::Vector, std::move(build), [expect](const Point& x, float* out) {
                for (int k = 0; k < 3; ++k) {
                    out[k] = expect(x, k);
                }
            }};
}

// Runs all cases as one program with an output parameter each.
class Emit : public ::testing::TestWithParam<BuildWay> {
protected:
    void run(const std::vector<Case>& cases) {
        ProgramBuilder builder("cases");
        Block body;
        const VarId zero = builder.constant(0);
        const VarId a = builder.param("a", Type::Float, Detail::Varying, zero);
        const VarId b = builder.param("b", Type::Float, Detail::Varying, zero);
        const VarId p = builder.param("p", Type::Point, Detail::Varying, zero);
        const VarId q = builder.param("q", Type::Vector, Detail::Varying, zero);
        const VarId m = builder.param("m", Type::Matrix, Detail::Varying, zero);
        const VarId u =
            builder.param("u", Type::Float, Detail::Uniform, builder.constant(uniform_u));
        const VarId up = builder.param("up", Type::Point, Detail::Uniform,
                                       builder.constant({1, 2, 3}, Type::Point));
        for (const Case& c : cases) {
            const VarId out =
                builder.param("out_of_" + c.name, c.type, Detail::Varying, zero, true);
            const VarId v = c.build(Setting{builder, body, a, b, p, q, m, u, up});
            body.push_back(builder.statement(Op::Copy, out, {v}));
        }
        builder.program.body = body;
        EmitRunner runner;
        const rt::ShaderObject* object = runner.build(builder.program, {}, GetParam());
        ASSERT_NE(object, nullptr) << runner.last_c;
        ASSERT_EQ(object->variant().lanes, GetParam().lanes);
        const rt::ShaderInstance instance(*object, {}, runner.services, nullptr, runner.strings,
                                          runner.diag);
        rt::ShadeBatch batch;
        for (const std::uint32_t n : batch_sizes) {
            batch.begin(instance, n);
            fill(batch, n);
            ASSERT_EQ(batch.run({&runner.services, nullptr}), 0U);
            check(cases, batch, n, runner.last_c);
        }
    }

private:
    static void fill(rt::ShadeBatch& batch, std::uint32_t n) {
        for (std::uint32_t i = 0; i < n; ++i) {
            const Point x = point_at(i);
            batch.param_plane(0)[i] = x.a;
            batch.param_plane(1)[i] = x.b;
            for (int k = 0; k < 3; ++k) {
                batch.param_plane(2, k)[i] = x.p[k];
                batch.param_plane(3, k)[i] = x.q[k];
            }
            for (int k = 0; k < 16; ++k) {
                batch.param_plane(4, k)[i] = x.m[k];
            }
        }
    }

    static void check(const std::vector<Case>& cases, rt::ShadeBatch& batch, std::uint32_t n,
                      const std::string& text) {
        for (std::size_t c = 0; c < cases.size(); ++c) {
            const int param = 7 + static_cast<int>(c);
            for (std::uint32_t i = 0; i < batch.stride(); ++i) {
                float expected[16] = {};
                if (i < n) {
                    cases[c].expect(point_at(i), expected);
                }
                for (int k = 0; k < num_components(cases[c].type); ++k) {
                    const float got = batch.param_plane(param, k)[i];
                    const bool same =
                        got == expected[k] || (std::isnan(got) && std::isnan(expected[k]));
                    ASSERT_TRUE(same)
                        << cases[c].name << " component " << k << " of point " << i << " of " << n
                        << ": " << got << " instead of " << expected[k] << "\n"
                        << text;
                }
            }
        }
    }
};

float mul_m(const float* a, const float* b, int k) {
    float sum = 0;
    for (int i = 0; i < 4; ++i) {
        sum += a[k / 4 * 4 + i] * b[i * 4 + k % 4];
    }
    return sum;
}

TEST_P(Emit, Arithmetic) {
    std::vector<Case> cases = {
        float_case(
            "add",
            [](const Setting& s) {
                return s.value(Op::Add, {s.a, s.b});
            },
            [](const Point& x) { return x.a + x.b; }),
        float_case(
            "sub",
            [](const Setting& s) {
                return s.value(Op::Sub, {s.a, s.u});
            },
            [](const Point& x) { return x.a - uniform_u; }),
        float_case(
            "mul",
            [](const Setting& s) {
                return s.value(Op::Mul, {s.builder.constant(-2), s.b});
            },
            [](const Point& x) { return -2 * x.b; }),
        float_case(
            "div",
            [](const Setting& s) {
                return s.value(Op::Div, {s.b, s.a});
            },
            [](const Point& x) { return x.b / x.a; }),
        float_case(
            "neg", [](const Setting& s) { return s.value(Op::Neg, {s.value(Op::Neg, {s.a})}); },
            [](const Point& x) { return x.a; }),
        float_case(
            "precedence",
            [](const Setting& s) {
                const VarId d = s.value(Op::Sub, {s.a, s.value(Op::Sub, {s.b, s.a})});
                return s.value(Op::Div, {d, s.value(Op::Mul, {s.b, s.value(Op::Add, {s.b, s.u})})});
            },
            [](const Point& x) { return (x.a - (x.b - x.a)) / (x.b * (x.b + uniform_u)); }),
        float_case(
            "uniform_to_lanes",
            [](const Setting& s) {
                const VarId t = s.value(Op::Mul, {s.u, s.u}, Type::Float, Detail::Uniform);
                return s.value(Op::Copy, {t});
            },
            [](const Point&) { return uniform_u * uniform_u; }),
        triple_case(
            "add_3",
            [](const Setting& s) {
                return s.value(Op::Add, {s.p, s.q}, Type::Point);
            },
            [](const Point& x, int k) { return x.p[k] + x.q[k]; }),
        triple_case(
            "sub_spread",
            [](const Setting& s) {
                return s.value(Op::Sub, {s.p, s.a}, Type::Point);
            },
            [](const Point& x, int k) { return x.p[k] - x.a; }),
        triple_case(
            "mul_3",
            [](const Setting& s) {
                return s.value(Op::Mul, {s.p, s.up}, Type::Point);
            },
            [](const Point& x, int k) { return x.p[k] * static_cast<float>(k + 1); }),
        triple_case(
            "scale",
            [](const Setting& s) {
                return s.value(Op::Mul, {s.b, s.q}, Type::Vector);
            },
            [](const Point& x, int k) { return x.q[k] * x.b; }),
        triple_case(
            "div_3",
            [](const Setting& s) {
                return s.value(Op::Div, {s.q, s.b}, Type::Vector);
            },
            [](const Point& x, int k) { return x.q[k] / x.b; }),
        triple_case(
            "over_3",
            [](const Setting& s) {
                return s.value(Op::Div, {s.u, s.up}, Type::Vector);
            },
            [](const Point&, int k) { return uniform_u / static_cast<float>(k + 1); }),
        triple_case(
            "neg_3", [](const Setting& s) { return s.value(Op::Neg, {s.q}, Type::Vector); },
            [](const Point& x, int k) { return -x.q[k]; }),
        triple_case(
            "spread", [](const Setting& s) { return s.value(Op::Copy, {s.a}, Type::Color); },
            [](const Point& x, int) { return x.a; }),
        float_case(
            "dot",
            [](const Setting& s) {
                return s.value(Op::Dot, {s.p, s.up});
            },
            [](const Point& x) { return x.p[0] * 1 + x.p[1] * 2 + x.p[2] * 3; }),
        triple_case(
            "cross",
            [](const Setting& s) {
                return s.value(Op::Cross, {s.p, s.q}, Type::Vector);
            },
            [](const Point& x, int k) {
                const int i = (k + 1) % 3;
                const int j = (k + 2) % 3;
                return x.p[i] * x.q[j] - x.p[j] * x.q[i];
            }),
        triple_case(
            "make",
            [](const Setting& s) {
                return s.value(Op::Triple, {s.a, s.u, s.b}, Type::Color);
            },
            [](const Point& x, int k) { return k == 0   ? x.a
                                               : k == 1 ? uniform_u
                                                        : x.b; }),
        float_case(
            "component_1",
            [](const Setting& s) {
                return s.value(Op::Component, {s.p, s.builder.constant(1)});
            },
            [](const Point& x) { return x.p[1]; }),
        float_case(
            "component_of_sum",
            [](const Setting& s) {
                const VarId t = s.value(Op::Add, {s.p, s.q}, Type::Point);
                return s.value(Op::Component, {t, s.builder.constant(2)});
            },
            [](const Point& x) { return x.p[2] + x.q[2]; }),
        float_case(
            "component_a",
            [](const Setting& s) {
                return s.value(Op::Component, {s.p, s.a});
            },
            [](const Point& x) { return x.p[std::clamp(static_cast<int>(x.a), 0, 2)]; }),
    };
    run(cases);
}

TEST_P(Emit, Matrices) {
    std::vector<Case> cases;
    cases.push_back({"mul_m", Type::Matrix,
                     [](const Setting& s) {
                         return s.value(Op::Mul, {s.m, s.m}, Type::Matrix);
                     },
                     [](const Point& x, float* out) {
                         for (int k = 0; k < 16; ++k) {
                             out[k] = mul_m(x.m, x.m, k);
                         }
                     }});
    cases.push_back({"neg_m", Type::Matrix,
                     [](const Setting& s) { return s.value(Op::Neg, {s.m}, Type::Matrix); },
                     [](const Point& x, float* out) {
                         for (int k = 0; k < 16; ++k) {
                             out[k] = -x.m[k];
                         }
                     }});
    cases.push_back({"sixteen", Type::Matrix,
                     [](const Setting& s) {
                         std::vector<VarId> args(16, s.u);
                         args[3] = s.a;
                         return s.value(Op::Matrix16, args, Type::Matrix);
                     },
                     [](const Point& x, float* out) {
                         for (int k = 0; k < 16; ++k) {
                             out[k] = k == 3 ? x.a : uniform_u;
                         }
                     }});
    cases.push_back({"diagonal", Type::Matrix,
                     [](const Setting& s) { return s.value(Op::Copy, {s.b}, Type::Matrix); },
                     [](const Point& x, float* out) {
                         for (int k = 0; k < 16; ++k) {
                             out[k] = k % 5 == 0 ? x.b : 0;
                         }
                     }});
    cases.push_back(float_case(
        "eq_m",
        [](const Setting& s) {
            const VarId d = s.value(Op::Copy, {s.b}, Type::Matrix);
            return s.value(Op::Ne, {d, s.m});
        },
        [](const Point&) { return 1.0F; }));
    run(cases);
}

TEST_P(Emit, RelationsAndLogic) {
    struct Relation {
        const char* name;
        Op op;
        bool (*holds)(float, float);
    };
    const Relation relations[] = {
        {"eq", Op::Eq, [](float x, float y) { return x == y; }},
        {"ne", Op::Ne, [](float x, float y) { return x != y; }},
        {"lt", Op::Lt, [](float x, float y) { return x < y; }},
        {"le", Op::Le, [](float x, float y) { return x <= y; }},
        {"gt", Op::Gt, [](float x, float y) { return x > y; }},
        {"ge", Op::Ge, [](float x, float y) { return x >= y; }},
    };
    std::vector<Case> cases;
    for (const Relation& r : relations) {
        cases.push_back(float_case(
            std::string(r.name) + "_f",
            [r](const Setting& s) {
                return s.value(r.op, {s.a, s.b});
            },
            [r](const Point& x) { return r.holds(x.a, x.b) ? 1.0F : 0.0F; }));
        cases.push_back(float_case(
            std::string(r.name) + "_u",
            [r](const Setting& s) {
                return s.value(r.op, {s.u, s.builder.constant(3)}, Type::Float, Detail::Uniform);
            },
            [r](const Point&) { return r.holds(3, 3) ? 1.0F : 0.0F; }));
        cases.push_back(float_case(
            std::string(r.name) + "_3",
            [r](const Setting& s) {
                return s.value(r.op, {s.p, s.q});
            },
            [r](const Point& x) {
                bool all = true;
                bool any = false;
                for (int k = 0; k < 3; ++k) {
                    all = all && r.holds(x.p[k], x.q[k]);
                    any = any || r.holds(x.p[k], x.q[k]);
                }
                return (r.op == Op::Ne ? any : all) ? 1.0F : 0.0F;
            }));
    }
    cases.push_back(float_case(
        "logic",
        [](const Setting& s) {
            const VarId x = s.value(Op::Lt, {s.a, s.b});
            const VarId y =
                s.value(Op::Gt, {s.u, s.builder.constant(5)}, Type::Float, Detail::Uniform);
            const VarId z =
                s.value(Op::And, {x, s.value(Op::Not, {y}, Type::Float, Detail::Uniform)});
            return s.value(Op::Or, {s.value(Op::Not, {z}), s.value(Op::And, {s.a, x})});
        },
        [](const Point& x) { return !(x.a < x.b) || (x.a != 0 && x.a < x.b) ? 1.0F : 0.0F; }));
    cases.push_back(float_case(
        "truth_as_number",
        [](const Setting& s) {
            const VarId x = s.value(Op::Lt, {s.a, s.b});
            return s.value(Op::Add, {s.value(Op::Mul, {x, s.u}), x});
        },
        [](const Point& x) { return x.a < x.b ? 4.0F : 0.0F; }));
    cases.push_back(float_case(
        "select",
        [](const Setting& s) {
            return s.value(Op::Select, {s.a, s.b, s.u});
        },
        [](const Point& x) { return x.a != 0 ? x.b : uniform_u; }));
    cases.push_back(triple_case(
        "select_3",
        [](const Setting& s) {
            const VarId c = s.value(Op::Lt, {s.a, s.b});
            return s.value(Op::Select, {c, s.p, s.up}, Type::Point);
        },
        [](const Point& x, int k) { return x.a < x.b ? x.p[k] : static_cast<float>(k + 1); }));
    cases.push_back(triple_case(
        "select_uniform",
        [](const Setting& s) {
            return s.value(Op::Select, {s.u, s.p, s.q}, Type::Point);
        },
        [](const Point& x, int k) { return x.p[k]; }));
    run(cases);
}

TEST_P(Emit, Arrays) {
    std::vector<Case> cases;
    const auto element = [](const Point& x, float index) {
        // array = {b, 10, 10 + a, 10}
        const int i = std::clamp(static_cast<int>(index), 0, 3);
        return i == 0 ? x.b : i == 2 ? 10 + x.a : 10.0F;
    };
    const auto make = [](const Setting& s, const std::string& name) {
        const VarId array = s.local(name, Type::Float, Detail::Varying, 4);
        s.set(array, s.builder.constant(10));
        s.block.push_back(s.builder.statement(Op::Store, array, {s.builder.constant(0), s.b}));
        const VarId t = s.value(Op::Add, {s.builder.constant(10), s.a});
        s.block.push_back(s.builder.statement(Op::Store, array, {s.builder.constant(2), t}));
        return array;
    };
    cases.push_back(float_case(
        "constant_index",
        [=](const Setting& s) {
            return s.value(Op::Load, {make(s, "arr1"), s.builder.constant(2)});
        },
        [=](const Point& x) { return element(x, 2); }));
    cases.push_back(float_case(
        "lane_index",
        [=](const Setting& s) {
            return s.value(Op::Load, {make(s, "arr2"), s.a});
        },
        [=](const Point& x) { return element(x, x.a); }));
    cases.push_back(float_case(
        "uniform_index_clamped",
        [=](const Setting& s) {
            const VarId i = s.value(Op::Mul, {s.u, s.u}, Type::Float, Detail::Uniform);
            return s.value(Op::Load, {make(s, "arr3"), i});
        },
        [=](const Point& x) { return element(x, 9); }));
    cases.push_back(float_case(
        "store_by_lane",
        [=](const Setting& s) {
            const VarId array = make(s, "arr4");
            s.block.push_back(s.builder.statement(Op::Store, array, {s.a, s.b}));
            return s.value(Op::Load, {array, s.builder.constant(1)});
        },
        [=](const Point& x) { return x.a == 1 ? x.b : 10.0F; }));
    cases.push_back(triple_case(
        "constant_table",
        [](const Setting& s) {
            const VarId table = s.builder.constant({1, 2, 3, 4, 5, 6}, Type::Color, 2);
            return s.value(Op::Load, {table, s.a}, Type::Color);
        },
        [](const Point& x, int k) {
            return static_cast<float>(k + 1) + (x.a >= 1 ? 3.0F : 0.0F);
        }));
    cases.push_back(triple_case(
        "copied_table",
        [](const Setting& s) {
            const VarId table = s.builder.constant({1, 2, 3, 4, 5, 6}, Type::Color, 2);
            const VarId copy = s.local("copy", Type::Color, Detail::Varying, 2);
            s.set(copy, table);
            s.block.push_back(s.builder.statement(Op::Store, copy, {s.builder.constant(0), s.p}));
            return s.value(Op::Load, {copy, s.a}, Type::Color);
        },
        [](const Point& x, int k) { return x.a >= 1 ? static_cast<float>(k + 4) : x.p[k]; }));
    run(cases);
}

// --- control flow

TEST_P(Emit, Branches) {
    std::vector<Case> cases;
    // y = -1; if (a < 1) { y = a; if (b > 1.3) y = y + b; } else y = u;
    cases.push_back(float_case(
        "varying_if",
        [](const Setting& s) {
            ProgramBuilder& p = s.builder;
            const VarId y = s.local("y1");
            s.set(y, p.constant(-1));
            Block inner{p.statement(Op::Add, y, {y, s.b})};
            Block yes{p.statement(Op::Copy, y, {s.a})};
            const VarId deep = p.value(yes, Op::Gt, {s.b, p.constant(1.3F)});
            yes.push_back(p.with_bodies(p.statement(Op::If, no_var, {deep}), {inner, {}}));
            Block no{p.statement(Op::Copy, y, {s.u})};
            const VarId c = s.value(Op::Lt, {s.a, p.constant(1)});
            s.block.push_back(p.with_bodies(p.statement(Op::If, no_var, {c}), {yes, no}));
            return y;
        },
        [](const Point& x) { return x.a < 1 ? (x.b > 1.3F ? x.a + x.b : x.a) : uniform_u; }));
    // uniform condition around a varying one; only the else arm has statements
    cases.push_back(float_case(
        "uniform_if",
        [](const Setting& s) {
            ProgramBuilder& p = s.builder;
            const VarId y = s.local("y2");
            Block inner{p.statement(Op::Copy, y, {p.constant(7)})};
            Block yes{p.statement(Op::Copy, y, {s.b})};
            const VarId c = p.value(yes, Op::Ne, {s.a, p.constant(0)});
            yes.push_back(p.with_bodies(p.statement(Op::If, no_var, {c}), {{}, inner}));
            s.block.push_back(p.with_bodies(p.statement(Op::If, no_var, {s.u}), {yes, {}}));
            return y;
        },
        [](const Point& x) { return x.a != 0 ? x.b : 7.0F; }));
    // an uninitialised local is zero in the lanes that never set it
    cases.push_back(float_case(
        "unset_is_zero",
        [](const Setting& s) {
            ProgramBuilder& p = s.builder;
            const VarId y = s.local("y3");
            Block yes{p.statement(Op::Copy, y, {s.b})};
            const VarId c = s.value(Op::Lt, {s.a, p.constant(0)});
            s.block.push_back(p.with_bodies(p.statement(Op::If, no_var, {c}), {yes, {}}));
            return y;
        },
        [](const Point& x) { return x.a < 0 ? x.b : 0.0F; }));
    run(cases);
}

// for (i = 0; i < limit; i += 1) { if (i == skip) continue; if (y > stop) break; y += b; }
struct LoopForm {
    std::string name;
    bool varying_limit, varying_skip, varying_stop;
};

float loop_expected(const LoopForm& form, const Point& x) {
    const float limit = form.varying_limit ? x.a + 3 : 5;
    const float skip = form.varying_skip ? x.a : 2;
    float y = 0;
    float n = 0;
    for (float i = 0; i < limit; i += 1) {
        n += 1;
        if (i == skip) {
            continue;
        }
        if ((form.varying_stop ? y : n) > 3) {
            break;
        }
        y += x.b;
    }
    return y + 100 * n;
}

VarId build_loop(const LoopForm& form, const Setting& s) {
    ProgramBuilder& p = s.builder;
    const Detail counter = form.varying_limit || form.varying_stop || form.varying_skip
                               ? Detail::Varying
                               : Detail::Uniform;
    const VarId i = s.local("i_" + form.name, Type::Float, counter);
    const VarId n = s.local("n_" + form.name, Type::Float, counter);
    const VarId y = s.local("y_" + form.name);
    s.set(i, p.constant(0));
    s.set(n, p.constant(0));
    s.set(y, p.constant(0));
    Block condition, body, step;
    const VarId limit =
        form.varying_limit ? p.value(condition, Op::Add, {s.a, p.constant(3)}) : p.constant(5);
    const VarId c = p.value(condition, Op::Lt, {i, limit}, Type::Float, counter);
    body.push_back(p.statement(Op::Add, n, {n, p.constant(1)}));
    const VarId skip = p.value(body, Op::Eq, {i, form.varying_skip ? s.a : p.constant(2)},
                               Type::Float, form.varying_skip ? Detail::Varying : counter);
    body.push_back(p.with_bodies(p.statement(Op::If, no_var, {skip}),
                                 {Block{p.statement(Op::Continue, no_var)}, {}}));
    const VarId stop = p.value(body, Op::Gt, {form.varying_stop ? y : n, p.constant(3)},
                               Type::Float, form.varying_stop ? Detail::Varying : counter);
    body.push_back(p.with_bodies(p.statement(Op::If, no_var, {stop}),
                                 {Block{p.statement(Op::Break, no_var)}, {}}));
    body.push_back(p.statement(Op::Add, y, {y, s.b}));
    step.push_back(p.statement(Op::Add, i, {i, p.constant(1)}));
    s.block.push_back(p.with_bodies(p.statement(Op::Loop, no_var, {c}), {condition, body, step}));
    return s.value(Op::Add, {y, s.value(Op::Mul, {n, p.constant(100)}, Type::Float, counter)});
}

TEST_P(Emit, Loops) {
    std::vector<Case> cases;
    for (int bits = 0; bits < 8; ++bits) {
        const LoopForm form{"form" + std::to_string(bits), (bits & 1) != 0, (bits & 2) != 0,
                            (bits & 4) != 0};
        cases.push_back(float_case(
            form.name, [form](const Setting& s) { return build_loop(form, s); },
            [form](const Point& x) { return loop_expected(form, x); }));
    }
    run(cases);
}

// Two nested loops; `leave` in the inner one breaks or continues the outer one.
struct NestForm {
    std::string name;
    bool varying;
    bool breaks;
};

float nest_expected(const NestForm& form, const Point& x) {
    float y = 0;
    for (int i = 0; i < 4; ++i) {
        bool left = false;
        for (int j = 0; j < 3; ++j) {
            y += 1;
            const float bound = form.varying ? x.b * 3 : 5;
            if (y > bound) {
                left = true;
                break;
            }
            y += 0.5F;
        }
        if (left) {
            if (form.breaks) {
                break;
            }
            continue;
        }
        y += 10;
    }
    return y;
}

VarId build_nest(const NestForm& form, const Setting& s) {
    ProgramBuilder& p = s.builder;
    const Detail d = form.varying ? Detail::Varying : Detail::Uniform;
    const VarId y = s.local("y_" + form.name, Type::Float, d);
    const VarId i = s.local("i_" + form.name, Type::Float, d);
    const VarId j = s.local("j_" + form.name, Type::Float, d);
    s.set(y, p.constant(0));
    s.set(i, p.constant(0));
    Block inner;
    inner.push_back(p.statement(Op::Add, y, {y, p.constant(1)}));
    const VarId bound =
        form.varying ? p.value(inner, Op::Mul, {s.b, p.constant(3)}) : p.constant(5);
    const VarId over = p.value(inner, Op::Gt, {y, bound}, Type::Float, d);
    Stmt leave = p.statement(form.breaks ? Op::Break : Op::Continue, no_var);
    leave.levels = 2;
    inner.push_back(p.with_bodies(p.statement(Op::If, no_var, {over}), {Block{leave}, {}}));
    inner.push_back(p.statement(Op::Add, y, {y, p.constant(0.5F)}));
    Block inner_condition, outer_condition;
    const VarId cj = p.value(inner_condition, Op::Lt, {j, p.constant(3)}, Type::Float, d);
    const VarId ci = p.value(outer_condition, Op::Lt, {i, p.constant(4)}, Type::Float, d);
    Block outer{p.statement(Op::Copy, j, {p.constant(0)})};
    outer.push_back(p.with_bodies(
        p.statement(Op::Loop, no_var, {cj}),
        {inner_condition, inner, Block{p.statement(Op::Add, j, {j, p.constant(1)})}}));
    outer.push_back(p.statement(Op::Add, y, {y, p.constant(10)}));
    s.block.push_back(p.with_bodies(
        p.statement(Op::Loop, no_var, {ci}),
        {outer_condition, outer, Block{p.statement(Op::Add, i, {i, p.constant(1)})}}));
    return y;
}

TEST_P(Emit, ExitsFromNestedLoops) {
    std::vector<Case> cases;
    for (int bits = 0; bits < 4; ++bits) {
        const NestForm form{"nest" + std::to_string(bits), (bits & 1) != 0, (bits & 2) != 0};
        cases.push_back(float_case(
            form.name, [form](const Setting& s) { return build_nest(form, s); },
            [form](const Point& x) { return nest_expected(form, x); }));
    }
    run(cases);
}

// An inlined function with early returns, called in a loop: lanes that returned come back for the
// next call.
TEST_P(Emit, ScopesWithEarlyReturn) {
    std::vector<Case> cases;
    for (const bool varying : {false, true}) {
        const std::string name = varying ? "lanes" : "together";
        cases.push_back(float_case(
            name,
            [=](const Setting& s) {
                ProgramBuilder& p = s.builder;
                const Detail d = varying ? Detail::Varying : Detail::Uniform;
                const VarId i = s.local("i_" + name, Type::Float, d);
                const VarId result = s.local("result_" + name);
                const VarId sum = s.local("sum_" + name);
                s.set(sum, p.constant(0));
                s.set(i, p.constant(0));
                Block inside;
                const VarId c = p.value(inside, Op::Gt, {varying ? s.a : s.u, i}, Type::Float, d);
                inside.push_back(p.with_bodies(
                    p.statement(Op::If, no_var, {c}),
                    {Block{p.statement(Op::Copy, result, {s.b}), p.statement(Op::Leave, no_var)},
                     {}}));
                inside.push_back(p.statement(Op::Copy, result, {p.constant(100)}));
                inside.push_back(p.statement(Op::Leave, no_var));
                Block body{p.with_bodies(p.statement(Op::Scope, no_var), {inside})};
                body.push_back(p.statement(Op::Add, sum, {sum, result}));
                Block condition;
                const VarId more = p.value(condition, Op::Lt, {i, p.constant(4)}, Type::Float, d);
                s.block.push_back(p.with_bodies(
                    p.statement(Op::Loop, no_var, {more}),
                    {condition, body, Block{p.statement(Op::Add, i, {i, p.constant(1)})}}));
                return sum;
            },
            [=](const Point& x) {
                float sum = 0;
                for (int i = 0; i < 4; ++i) {
                    sum += (varying ? x.a : uniform_u) > static_cast<float>(i) ? x.b : 100.0F;
                }
                return sum;
            }));
    }
    run(cases);
}

// A break inside a function that is inside a loop inside a function: leaves two scopes' worth of
// masks behind.
TEST_P(Emit, LeaveCrossesLoops) {
    run({float_case(
        "find_first",
        [](const Setting& s) {
            ProgramBuilder& p = s.builder;
            const VarId i = s.local("i_find");
            const VarId found = s.local("found");
            s.set(found, p.constant(-1));
            Block body;
            const VarId hit = p.value(body, Op::Ge, {i, s.a});
            body.push_back(p.with_bodies(
                p.statement(Op::If, no_var, {hit}),
                {Block{p.statement(Op::Copy, found, {i}), p.statement(Op::Leave, no_var)}, {}}));
            Block condition;
            const VarId more = p.value(condition, Op::Lt, {i, p.constant(3)});
            Block inside{p.statement(Op::Copy, i, {p.constant(-2)})};
            inside.push_back(p.with_bodies(
                p.statement(Op::Loop, no_var, {more}),
                {condition, body, Block{p.statement(Op::Add, i, {i, p.constant(1)})}}));
            inside.push_back(p.statement(Op::Copy, found, {p.constant(50)}));
            s.block.push_back(p.with_bodies(p.statement(Op::Scope, no_var), {inside}));
            return found;
        },
        [](const Point& x) { return x.a <= -2 ? -2.0F
                                    : x.a < 3 ? x.a
                                              : 50.0F; })});
}

TEST_P(Emit, BuiltinsWithOutputs) {
    std::vector<Case> cases;
    // fresnel and setxcomp under a mask leave the other lanes alone
    cases.push_back(triple_case(
        "setcomp_masked",
        [](const Setting& s) {
            ProgramBuilder& p = s.builder;
            const VarId v = s.local("v1", Type::Point);
            s.set(v, s.p);
            const VarId c = s.value(Op::Lt, {s.a, p.constant(0)});
            Block yes{p.call("setycomp", no_var, {v, s.b})};
            s.block.push_back(p.with_bodies(p.statement(Op::If, no_var, {c}), {yes, {}}));
            return v;
        },
        [](const Point& x, int k) { return k == 1 && x.a < 0 ? x.b : x.p[k]; }));
    cases.push_back(float_case(
        "min_of_three",
        [](const Setting& s) {
            const VarId t = s.builder.temp();
            s.block.push_back(s.builder.call("min_f", t, {s.a, s.b, s.u}));
            return t;
        },
        [](const Point& x) { return std::min(std::min(x.a, x.b), uniform_u); }));
    cases.push_back(float_case(
        "clamp",
        [](const Setting& s) {
            const VarId t = s.builder.temp();
            s.block.push_back(
                s.builder.call("clamp_f", t, {s.a, s.builder.constant(-1), s.builder.constant(1)}));
            return s.value(Op::Mul, {t, t});
        },
        [](const Point& x) { return x.a == 0 ? 0.0F : 1.0F; }));
    run(cases);
}

std::string way_name(const ::testing::TestParamInfo<BuildWay>& info) {
    return "Lanes" + std::to_string(info.param.lanes) + "O" +
           std::to_string(info.param.optimisation);
}

INSTANTIATE_TEST_SUITE_P(Ways, Emit, ::testing::ValuesIn(all_ways()), way_name);

} // namespace
} // namespace slc
