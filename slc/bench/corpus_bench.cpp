// SPDX-License-Identifier: Apache-2.0
// Shaders as people write them: time per point on 8 lanes, 4 lanes, as one lane (the same emitter
// as plain C) and in the interpreter, and the time to compile each. One thread, batches of 256
// points, pattern and own highlight, no lights of a scene. marble.sl also by hand in lanes.
// Prints JSON lines (docs/benchmarks.md). Arguments: the .sl files, marble.sl first.
#include "slc/bench/marble.h"
#include "slc/driver.h"
#include "slc/emit_runner.h"
#include "slc/interp.h"
#include "slc/ir_text.h"
#include "slc/specialise.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>

namespace {

using Clock = std::chrono::steady_clock;
using slc::Program;
using slc::Value;

constexpr std::uint32_t num_points = 256;
constexpr int num_interpreted = 32;

// What others measured (design.md, section 9: OSL batched on AVX2, net of its base): for the eye
// only, another machine and other texts of the same kind.
struct Stated {
    const char* name;
    double osl_ns;
};
constexpr Stated stated[] = {
    {"marble", 147}, {"brick", 34}, {"wood", 547}, {"uberlight", 112}, {"noise_phong", 131}};

template <class Run> double best_seconds(int samples, Run run) {
    double best = 1e30;
    for (int i = 0; i < samples; ++i) {
        const auto start = Clock::now();
        run();
        best = std::min(best, std::chrono::duration<double>(Clock::now() - start).count());
    }
    return best;
}

// Inputs as a patch of surface a few units from the eye has them.
float input(int id, int component, int point) {
    const float f = static_cast<float>(point), k = static_cast<float>(component);
    const float u = static_cast<float>(point % 16) / 16, v = static_cast<float>(point / 16) / 16;
    switch (id) {
    case SL_VAR_P:
    case SL_VAR_Ps:
        return component == 2 ? 4 + std::sin(0.3F * f) : 2 * (component == 0 ? u : v) - 1;
    case SL_VAR_N:
    case SL_VAR_Ng:
        return component == 2 ? -0.9F : 0.4F * std::sin(0.11F * f + k);
    case SL_VAR_I:
        return component == 2 ? 4 + std::sin(0.3F * f) : 2 * (component == 0 ? u : v) - 1;
    case SL_VAR_u:
    case SL_VAR_s:
        return u;
    case SL_VAR_v:
    case SL_VAR_t:
        return v;
    case SL_VAR_du:
    case SL_VAR_dv:
        return 1.0F / 64;
    case SL_VAR_E:
        return 0;
    case SL_VAR_Os:
        return 1;
    default:
        return 0.3F + 0.2F * k;
    }
}

bool is_uniform(const slc::VariableRow& row) {
    return row.detail == slc::Detail::Uniform;
}

void fill(rt::ShadeBatch& batch) {
    for (int id = 0; id < SL_VAR_COUNT; ++id) {
        const auto v = static_cast<sl_variable>(id);
        const slc::VariableRow& row = slc::variable_rows()[static_cast<std::size_t>(id)];
        for (int k = 0; batch.has(v) && k < slc::num_components(row.type); ++k) {
            for (std::uint32_t i = 0; i < (is_uniform(row) ? 1 : num_points); ++i) {
                float* plane = is_uniform(row) ? batch.uniform(v) + k : batch.plane(v, k);
                plane[i] = input(id, k, static_cast<int>(i));
            }
        }
        const float size = 1.0F / 16; // differences to the auxiliary points
        for (int k = 0; batch.aux_u(v) != nullptr && k < slc::num_components(row.type); ++k) {
            for (std::uint32_t i = 0; i < num_points; ++i) {
                batch.aux_u(v, k)[i] = k == 0 ? size : 0;
                batch.aux_v(v, k)[i] = k == 1 || slc::num_components(row.type) == 1 ? size : 0;
            }
        }
    }
}

// One width of one shader, ready to run.
class Compiled {
public:
    // With `general`: made from it, with its parameters.
    Compiled(const Program& program, int lanes, const Compiled* general = nullptr) {
        slc::CompileOptions options;
        options.exact = general != nullptr;
        Program ready = program;
        slc::resolve_area_operators(ready, options);
        shader_ = runner_.build(ready, slc::analyse(ready), {lanes, 2});
        if (!shader_) {
            return;
        }
        instance_ = general != nullptr
                        ? std::make_unique<rt::ShaderInstance>(*shader_, *general->instance_)
                        : std::make_unique<rt::ShaderInstance>(
                              *shader_, std::span<const rt::BoundValue>(), runner_.services,
                              nullptr, runner_.strings, runner_.diag);
        batch_.begin(*instance_, num_points);
        fill(batch_);
        batch_.run({&runner_.services, nullptr});
        results_ = results();
    }
    [[nodiscard]] bool ok() const { return shader_ != nullptr; }
    void run() {
        const sl_variant& variant = shader_->variant();
        const auto lanes = static_cast<std::uint32_t>(variant.lanes);
        for (std::uint32_t first = 0; first < num_points; first += lanes) {
            variant.shade(&batch_.raw(), first, lanes, nullptr);
        }
    }
    // Of the first run: Ci and Oi, or Cl.
    [[nodiscard]] const std::vector<float>& first_results() const { return results_; }
    [[nodiscard]] rt::ShadeBatch& batch() { return batch_; }
    [[nodiscard]] const rt::ShaderInstance& instance() const { return *instance_; }

private:
    [[nodiscard]] std::vector<float> results() {
        std::vector<float> all;
        for (const sl_variable id : {SL_VAR_Ci, SL_VAR_Oi, SL_VAR_Cl}) {
            for (int k = 0; batch_.has(id) && k < 3; ++k) {
                all.insert(all.end(), batch_.plane(id, k), batch_.plane(id, k) + num_points);
            }
        }
        return all;
    }
    slc::EmitRunner runner_;
    const rt::ShaderObject* shader_ = nullptr;
    std::unique_ptr<rt::ShaderInstance> instance_;
    rt::ShadeBatch batch_;
    std::vector<float> results_;
};

// Seconds per point in the interpreter.
double interpreted(const Program& as_written) {
    Program program = as_written;
    slc::resolve_area_operators(program, {});
    slc::InterpHost host;
    return best_seconds(2,
                        [&] {
                            slc::Interpreter interpreter(program, host, num_interpreted);
                            for (int id = 0; id < SL_VAR_COUNT; ++id) {
                                const slc::VariableRow& row =
                                    slc::variable_rows()[static_cast<std::size_t>(id)];
                                for (int i = 0; i < num_interpreted; ++i) {
                                    Value value = Value::zero(row.type, 0);
                                    for (int k = 0; k < slc::num_components(row.type) &&
                                                    row.type != slc::Type::String;
                                         ++k) {
                                        value.x[static_cast<std::size_t>(k)] = input(id, k, i);
                                    }
                                    interpreter.set_global(id, i, value);
                                }
                            }
                            interpreter.run();
                        }) /
           num_interpreted;
}

struct Row {
    std::string name, unit, note, error;
    double value = 0, limit = 0;
    bool higher = false;
};

void print(const Row& row) {
    std::printf("{\"name\": \"%s\", \"value\": %.4g, \"unit\": \"%s\"", row.name.c_str(), row.value,
                row.unit.c_str());
    if (row.limit > 0) {
        std::printf(", \"limit\": %g, \"better\": \"%s\"", row.limit,
                    row.higher ? "higher" : "lower");
    }
    if (!row.error.empty()) {
        std::printf(", \"error\": \"%s\"", row.error.c_str());
    }
    std::printf(", \"note\": \"%s\"}\n", row.note.c_str());
    std::fflush(stdout);
}

std::string text(const char* format, auto... values) {
    char buffer[256];
    std::snprintf(buffer, sizeof buffer, format, values...);
    return buffer;
}

bool same_bits(const Compiled& a, const Compiled& b) {
    const std::vector<float>&x = a.first_results(), &y = b.first_results();
    return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(float)) == 0;
}

// Best of many short samples taken in turn.
std::vector<double> ns_per_point(const std::vector<std::function<void()>>& ways) {
    std::vector<double> best(ways.size(), 1e30);
    for (int sample = 0; sample < 40; ++sample) {
        for (std::size_t way = 0; way < ways.size(); ++way) {
            constexpr int repeats = 10;
            const double s = best_seconds(1, [&] {
                for (int i = 0; i < repeats; ++i) {
                    ways[way]();
                }
            });
            best[way] = std::min(best[way], 1e9 * s / (repeats * double(num_points)));
        }
    }
    return best;
}

void compile_times(const std::string& name, const std::string& file) {
    base::Diag diag;
    slc::ObjectOptions options;
    options.native_only = true;
    const double whole = best_seconds(3, [&] { (void)slc::compile_to_bytes(file, options, diag); });
    const double front = best_seconds(3, [&] {
        const slc::Unit unit = slc::compile_file(file, {}, diag);
        (void)slc::c_text(unit.programs.front(), slc::native_lanes(), options);
    });
    print({"compile " + name, "ms",
           text("native; preprocessor, front end and emitter %.1f, C compiler and linker %.1f",
                1e3 * front, 1e3 * (whole - front)),
           "exact", 1e3 * whole, 300});
}

// The parameters at their defaults as constants: what is gained, and from how many points on that
// repays the compiler.
bool specialised(const std::string& name, const Program& program, Compiled& general) {
    std::vector<slc::ConstantParam> constants;
    const sl_object& object = general.instance().object();
    for (int i = 0; i < object.num_params; ++i) {
        const sl_param& p = object.params[i];
        const bool is_string = p.type == SL_TYPE_string;
        const int n = std::max(p.array_length, 1) * rt::components_of(p.type);
        const float* floats = is_string ? nullptr : general.instance().uniform_floats(i);
        constants.push_back(
            {p.name, is_string ? std::vector<float>() : std::vector<float>(floats, floats + n),
             is_string ? general.instance().uniform_string(i) : ""});
    }
    std::string error;
    const auto special = slc::specialise(slc::print_ir(program), constants, error);
    if (!special) {
        return false;
    }
    Compiled fixed(special->program, slc::native_lanes(), &general);
    if (!fixed.ok()) {
        return false;
    }
    slc::ObjectOptions options;
    options.native_only = true;
    base::Diag diag;
    const double compile_s =
        best_seconds(3, [&] { (void)slc::build_object(special->program, options, diag); });
    const std::vector<double> ns = ns_per_point({[&] { general.run(); }, [&] { fixed.run(); }});
    const double gain_ns = ns[0] - ns[1];
    const std::string pays = gain_ns > 0.5
                                 ? text("pays from %.1f M points on", 1e3 * compile_s / gain_ns)
                                 : std::string("never pays");
    const bool same = same_bits(general, fixed);
    print({name + ", specialised / general", "ratio",
           text("%.1f and %.1f ns/point; %zu statements compiled in %.0f ms; %s", ns[1], ns[0],
                special->num_statements, 1e3 * compile_s, pays.c_str()),
           same ? "same bits" : "bits differ", ns[1] / ns[0]});
    return same;
}

double largest_difference(const float* a, const float* b, std::size_t n) {
    double worst = 0;
    for (std::size_t i = 0; i < n; ++i) {
        worst = std::max(worst, std::abs(double(a[i]) - double(b[i])));
    }
    return worst;
}

// The limit: the same picture by hand.
void marble_by_hand(Compiled& emitted) {
    rt::ShadeBatch& batch = emitted.batch();
    alignas(64) static float Ci[3 * num_points], Oi[3 * num_points];
    const marble_in in = {batch.plane(SL_VAR_P),
                          batch.plane(SL_VAR_N),
                          batch.plane(SL_VAR_I),
                          batch.plane(SL_VAR_Cs),
                          batch.plane(SL_VAR_Os),
                          1,
                          1.6F,
                          .2F,
                          .8F,
                          .3F,
                          24,
                          {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
                          batch.stride(),
                          num_points};
    const std::vector<double> ns =
        ns_per_point({[&] { emitted.run(); }, [&] { marble_lanes(&in, Ci, Oi); }});
    const double error = largest_difference(Ci, emitted.first_results().data(), 3 * num_points);
    print({"marble, emitted code / hand-written lanes", "ratio",
           text("%.1f ns/point by hand", ns[1]), text("%.1e", error), ns[0] / ns[1], 1.3});
}

bool measure(const std::string& file) {
    const std::string name = std::filesystem::path(file).stem().string();
    base::Diag diag;
    const slc::Unit unit = slc::compile_file(file, {}, diag);
    if (!unit.ok() || unit.programs.empty()) {
        return false;
    }
    const Program& program = unit.programs.front();
    Compiled eight(program, slc::native_lanes()), four(program, 4), one(program, 1);
    if (!eight.ok() || !four.ok() || !one.ok()) {
        return false;
    }
    const std::vector<double> ns =
        ns_per_point({[&] { eight.run(); }, [&] { four.run(); }, [&] { one.run(); }});
    const double slow = 1e9 * interpreted(program);
    std::string note = text("%.1f M points/s; width 1, 4, 8: %.1f, %.1f, %.1f; interpreter %.0f",
                            1e3 / ns[0], ns[2], ns[1], ns[0], slow);
    for (const Stated& s : stated) {
        note += s.name == name ? text("; stated for OSL: %.0f", s.osl_ns) : "";
    }
    const bool same = same_bits(eight, four); // one lane is for the time only (spd-007)
    print({name + ", 8 lanes", "ns/point", note, same ? "same bits" : "widths differ", ns[0]});
    print({name + ", one lane / 8 lanes", "ratio",
           "the same emitter with one lane of the vector types, which is not the best scalar C", "",
           ns[2] / ns[0]});
    compile_times(name, file);
    const bool special_same = specialised(name, program, eight);
    if (name == "marble" && slc::native_lanes() == 8) {
        marble_by_hand(eight);
    }
    return same && special_same;
}

} // namespace

int main(int argc, char** argv) {
    bool ok = argc > 1;
    for (int i = 1; i < argc; ++i) {
        ok = measure(argv[i]) && ok;
    }
    return ok ? 0 : 1;
}
