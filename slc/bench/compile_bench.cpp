// SPDX-License-Identifier: Apache-2.0
// Milliseconds to compile a 150-line shader for this machine, and what of it the header and the
// bare C compiler take. Warm file cache. Prints JSON lines (docs/benchmarks.md).
#include "slc/driver.h"
#include "slc/emit_runner.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>

namespace {

// The best of several runs: what else the machine does only adds time.
template <class Run> double best_ms(int runs, Run run) {
    std::vector<double> times;
    for (int i = 0; i < runs; ++i) {
        const auto start = std::chrono::steady_clock::now();
        run();
        const std::chrono::duration<double, std::milli> elapsed =
            std::chrono::steady_clock::now() - start;
        times.push_back(elapsed.count());
    }
    return *std::min_element(times.begin(), times.end());
}

// A layered material: 150 lines of what surface shaders are made of.
std::string long_shader() {
    std::string text =
        "surface layered(float Ka = 1, Kd = .5, Ks = .5, roughness = .1; color base = (.5, .4, "
        ".3);) {\n"
        "    normal Nf = faceforward(normalize(N), I);\n    vector V = -normalize(I);\n"
        "    point PP = transform(\"shader\", P);\n    color Ct = base;\n    float n, m;\n";
    for (int layer = 0; layer < 20; ++layer) {
        const std::string k = std::to_string(layer + 1);
        text += "    n = noise(PP * " + k + ") - 0.5;\n";
        text += "    m = smoothstep(0.1, 0.6, abs(n));\n";
        text += "    if (m > 0.3) {\n";
        text += "        Ct = mix(Ct, color (m, n, 0." + k + "), m * u);\n";
        text += "    } else {\n";
        text += "        Ct *= 1 - 0.1 * cellnoise(PP * " + k + ");\n";
        text += "    }\n";
    }
    return text + "    Oi = Os;\n    Ci = Os * (Cs * Ct * (Ka * ambient() + Kd * diffuse(Nf)) + Ks "
                  "* specular(Nf, V, roughness));\n}\n";
}

void print(const char* name, double value, double limit, const char* note) {
    std::printf("{\"name\": \"%s\", \"value\": %.1f, \"unit\": \"ms\", \"limit\": %g, \"better\": "
                "\"lower\", "
                "\"error\": \"exact\", \"note\": \"%s\"}\n",
                name, value, limit, note);
}

} // namespace

int main() {
    slc::ScratchDir dir;
    base::Diag diag;
    const std::string source = dir.path() + "/layered.sl";
    const std::string object = dir.path() + "/layered.slo";
    std::ofstream(source) << long_shader();
    slc::ObjectOptions native;
    native.native_only = true;
    slc::ObjectOptions both;
    bool ok = true;
    const double ms_native =
        best_ms(7, [&] { ok = slc::compile_to_object(source, object, native, diag) && ok; });
    const double ms_both =
        best_ms(5, [&] { ok = slc::compile_to_object(source, object, both, diag) && ok; });
    const double ms_front = best_ms(7, [&] {
        const slc::Unit unit = slc::compile_file(source, native.front, diag);
        ok = unit.ok() && !slc::c_text(unit.programs.front(), 8, native).empty() && ok;
    });
    const double ms_key =
        best_ms(21, [&] { ok = slc::object_key(source, native, diag).has_value() && ok; });
    const auto tools = slc::find_toolchain("", diag);
    const int lanes = slc::native_lanes();
    const auto compile = [&](const std::string& text) {
        return best_ms(7, [&] {
            ok = slc::build_shared_object(*tools, {{lanes, text}}, {}, object, diag) && ok;
        });
    };
    const std::string nothing = "int nothing;\n";
    const std::string header =
        "#define SL_LANES " + std::to_string(lanes) + "\n#include \"sl_shader.h\"\n";
    const double ms_empty = compile(nothing);
    const double ms_header = compile(header) - ms_empty;
    if (!ok) {
        return 1;
    }
    print("slc, 150-line shader, native", ms_native, 300, "from SL text to a loaded-ready object");
    print("slc, 150-line shader, both variants", ms_both, 600,
          "ahead of time: AVX2 and plain x86-64");
    print("slc, front end and emitter", ms_front, 50, "preprocessor included");
    print("slc, cache key", ms_key, 2, "what a shader in the cache costs before it is opened");
    print("sl_shader.h", ms_header, 50, "compile time it adds to an empty file");
    return 0;
}
