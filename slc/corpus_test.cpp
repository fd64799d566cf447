// SPDX-License-Identifier: Apache-2.0
// All shaders of shaders/ and testsuite/sl/corpus: they compile, their IR is sound before and after
// the passes and survives its text form, and the passes do not change what the shaders compute.
#include "slc/builtins.h"
#include "slc/slc_testing.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>

namespace slc {
namespace {

using testing::QuietDiag;
namespace fs = std::filesystem;

fs::path root_folder() {
    const char* const root = std::getenv("PERIGEE_SOURCE_ROOT");
    return root != nullptr ? root : ".";
}

// With the headers that shaders may count on.
CompileOptions options_with_headers() {
    CompileOptions options;
    options.standard_headers = (root_folder() / "shaders/headers").string();
    return options;
}

// The "// warns: text" lines at the head of a shader: what it must be warned about, no more.
std::multiset<std::string> expected_warnings(const fs::path& path) {
    std::multiset<std::string> expected;
    std::ifstream file(path);
    const std::string mark = "// warns: ";
    for (std::string line; std::getline(file, line) && line.starts_with("//");) {
        if (line.starts_with(mark)) {
            expected.insert(line.substr(mark.size()));
        }
    }
    return expected;
}

std::vector<fs::path> all_shaders() {
    std::vector<fs::path> paths;
    for (const char* folder : {"shaders", "testsuite/sl/corpus"}) {
        for (const auto& entry : fs::directory_iterator(root_folder() / folder)) {
            if (entry.path().extension() == ".sl") {
                paths.push_back(entry.path());
            }
        }
    }
    std::sort(paths.begin(), paths.end());
    return paths;
}

void expect_sound(const Program& program) {
    const auto complaints = verify_ir(program);
    EXPECT_TRUE(complaints.empty()) << program.name << ": " << complaints.front();
    const std::string text = print_ir(program);
    std::string error;
    const auto back = parse_ir(text, error);
    ASSERT_TRUE(back) << program.name << ": " << error;
    EXPECT_EQ(print_ir(*back), text);
}

// Lights and messages with values that depend on the point only.
class Host : public InterpHost {
public:
    int num_lights() override { return 2; }
    bool light(int index, int point, const Triple3&, const Triple3&, double,
               const std::string& category, LightSample& sample) override {
        const double v = .25 * (index + 1) + .125 * point;
        sample.L = {v, index == 0 ? 1.0 : 0.0, 2};
        sample.Cl = {v, .5, 1};
        return category != "key" || index == 0;
    }
    Triple3 ambient(int, const Triple3&) override { return {.1, .2, .3}; }
    bool space(const std::string&, const std::string&, int, Matrix16& m) override {
        m = {2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 1};
        return true;
    }
    void print(const std::string& text) override { printed += text; }
    std::string printed;
};

constexpr int num_points = 4;

void fill(Interpreter& interpreter) {
    const auto rows = variable_rows();
    for (int p = 0; p < num_points; ++p) {
        for (std::size_t i = 0; i < rows.size(); ++i) {
            Value v = Value::zero(rows[i].type);
            for (std::size_t c = 0; c < v.x.size(); ++c) { // between 0 and 1, different everywhere
                const double x = std::sin(1.0 + 12.9898 * static_cast<double>(i) +
                                          78.233 * static_cast<double>(c) + p) *
                                 43758.5453;
                v.x[c] = x - std::floor(x);
            }
            interpreter.set_global(static_cast<int>(i), p, v);
        }
    }
}

// Values that are equal up to the rounding of folded constants to float.
bool close(const Value& a, const Value& b) {
    if (a.s != b.s || a.x.size() != b.x.size()) {
        return false;
    }
    for (std::size_t i = 0; i < a.x.size(); ++i) {
        const bool both_odd = !std::isfinite(a.x[i]) && !std::isfinite(b.x[i]);
        if (!both_odd && std::abs(a.x[i] - b.x[i]) > 1e-5 * std::max(1.0, std::abs(a.x[i]))) {
            return false;
        }
    }
    return true;
}

std::string show(const Value& v) {
    std::string out;
    for (const double x : v.x) {
        out += " " + std::to_string(x);
    }
    return out;
}

void expect_same_results(const Program& before, const Program& after) {
    Host host_before;
    Host host_after;
    Interpreter a(before, host_before, num_points);
    Interpreter b(after, host_after, num_points);
    fill(a);
    fill(b);
    EXPECT_TRUE(a.run());
    EXPECT_TRUE(b.run());
    EXPECT_EQ(host_before.printed, host_after.printed) << before.name;
    for (int p = 0; p < num_points; ++p) {
        for (const int id : {SL_VAR_Ci, SL_VAR_Oi, SL_VAR_alpha}) {
            EXPECT_TRUE(close(a.global(id, p), b.global(id, p)))
                << before.name << " point " << p << ":" << show(a.global(id, p)) << " /"
                << show(b.global(id, p));
        }
        const bool has_place = before.shader_type == SL_SHADER_displacement;
        for (const int id : {SL_VAR_P, SL_VAR_N}) {
            EXPECT_TRUE(!has_place || close(a.global(id, p), b.global(id, p)))
                << before.name << " point " << p;
        }
        const bool is_light = before.shader_type == SL_SHADER_light;
        for (const int id : {SL_VAR_Cl, SL_VAR_L}) {
            EXPECT_TRUE(!is_light || close(a.global(id, p), b.global(id, p)))
                << before.name << " point " << p;
        }
        for (const Param& param : before.params) {
            const Var& v = before.vars[static_cast<std::size_t>(param.var)];
            EXPECT_TRUE(!v.is_output || close(a.param(v.name, p), b.param(v.name, p)))
                << before.name << " " << v.name;
        }
    }
}

TEST(Corpus, CompilesSoundAndUnchangedByPasses) {
    const auto paths = all_shaders();
    EXPECT_GE(paths.size(), 110U);
    std::size_t programs = 0;
    for (const fs::path& path : paths) {
        QuietDiag diag;
        CompileOptions plain = options_with_headers();
        plain.optimise = false;
        const Unit raw = compile_file(path.string(), plain, diag.get());
        EXPECT_TRUE(raw.ok()) << diag.text();
        for (const Program& before : raw.programs) {
            Program after = before;
            run_passes(after, {});
            expect_sound(before);
            expect_sound(after);
            expect_same_results(before, after);
            ++programs;
        }
    }
    EXPECT_GE(programs, 112U);
}

TEST(Corpus, WarnsWhereDeservedOnly) {
    for (const fs::path& path : all_shaders()) {
        QuietDiag diag;
        (void)compile_file(path.string(), options_with_headers(), diag.get());
        std::multiset<std::string> expected = expected_warnings(path);
        for (const std::string& message : diag.get().messages()) {
            const auto known =
                std::find_if(expected.begin(), expected.end(), [&](const std::string& text) {
                    return message.find(text) != std::string::npos;
                });
            EXPECT_NE(known, expected.end()) << message;
            if (known != expected.end()) {
                expected.erase(known);
            }
        }
        EXPECT_TRUE(expected.empty()) << path << ": no warning about " << *expected.begin();
    }
}

// A header alone is a shader's beginning like any other.
TEST(Corpus, HeadersStandAlone) {
    for (const auto& entry : fs::directory_iterator(root_folder() / "shaders/headers")) {
        QuietDiag diag;
        const std::string text =
            "#include \"" + entry.path().filename().string() + "\"\nsurface t() { Ci = 1; }\n";
        EXPECT_TRUE(compile_text(text, "t.sl", options_with_headers(), diag.get()).ok());
        EXPECT_EQ(diag.text(), "");
    }
}

// A variable the analysis calls unneeded may hold anything: garbage in it changes nothing.
TEST(Corpus, UnneededVariablesDoNotMatter) {
    for (const fs::path& path : all_shaders()) {
        QuietDiag diag;
        const Unit unit = compile_file(path.string(), options_with_headers(), diag.get());
        for (Program program : unit.programs) {
            resolve_area_operators(program, {});
            expect_sound(program);
            const Facts facts = analyse(program);
            Host host;
            Interpreter clean(program, host, num_points);
            Interpreter dirty(program, host, num_points);
            fill(clean);
            fill(dirty);
            for (int id = 0; id < SL_VAR_COUNT; ++id) {
                const bool is_result = (facts.written >> id & 1) == 0;
                for (int p = 0; p < num_points && (facts.needed >> id & 1) == 0; ++p) {
                    Value garbage = dirty.global(id, p);
                    std::fill(garbage.x.begin(), garbage.x.end(), 1e30);
                    dirty.set_global(id, p, garbage);
                    if (is_result) { // not written: stays what the engine has, so compare like with
                                     // like
                        clean.set_global(id, p, garbage);
                    }
                }
            }
            EXPECT_TRUE(clean.run());
            EXPECT_TRUE(dirty.run());
            for (int p = 0; p < num_points; ++p) {
                for (const int id : {SL_VAR_Ci, SL_VAR_Oi}) {
                    EXPECT_TRUE(close(clean.global(id, p), dirty.global(id, p)))
                        << program.name << " point " << p;
                }
            }
        }
    }
}

TEST(Corpus, Dumps) {
    const std::string path = all_shaders().front().string();
    for (const char* name : {"tokens", "ast", "ir", "points", "facts"}) {
        QuietDiag diag;
        const auto kind = dump_kind(name);
        ASSERT_TRUE(kind);
        const auto text = dump_file(path, *kind, {}, diag.get());
        ASSERT_TRUE(text);
        EXPECT_FALSE(text->empty());
    }
    EXPECT_FALSE(dump_kind("bytecode"));
}

} // namespace
} // namespace slc
