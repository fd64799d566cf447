// SPDX-License-Identifier: Apache-2.0
// Milliseconds to compile a 150-line shader for this machine, and what of it the header and the
// bare C compiler take; and to get it from the shader cache: found on the path, identified, checked
// and loaded, by a library made for it as in a new run. Warm file cache. Prints JSON lines
// (docs/benchmarks.md).
#include "slc/driver.h"
#include "slc/emit_runner.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <thread>

namespace {

template <class Run> std::vector<double> times_ms(int runs, Run run) {
    std::vector<double> times;
    for (int i = 0; i < runs; ++i) {
        const auto start = std::chrono::steady_clock::now();
        run();
        const std::chrono::duration<double, std::milli> elapsed =
            std::chrono::steady_clock::now() - start;
        times.push_back(elapsed.count());
    }
    std::sort(times.begin(), times.end());
    return times;
}

// The best of several runs: what else the machine does only adds time.
template <class Run> double best_ms(int runs, Run run) {
    return times_ms(runs, run).front();
}
template <class Run> double median_ms(int runs, Run run) {
    return times_ms(runs, run)[static_cast<std::size_t>(runs) / 2];
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
    std::printf("{\"name\": \"%s\", \"value\": %.2f, \"unit\": \"ms\", \"limit\": %g, \"better\": "
                "\"lower\", "
                "\"error\": \"exact\", \"note\": \"%s\"}\n",
                name, value, limit, note);
}

// A library of its own each time, as in a new process; the object is in the cache before.
double cached_ms(const std::string& dir, const char* name, const slc::ObjectOptions& options,
                 bool& ok) {
    base::Diag diag;
    rt::StringTable strings;
    rt::ShaderLibrary::Config config;
    config.search_path = {dir};
    config.cache_dir = options.index_dir;
    config.compile = [&](const std::string& sl, base::Diag& said, const rt::Cancelled&) {
        return slc::compile_to_bytes(sl, options, said);
    };
    config.cache_key = [&](const std::string& sl, base::Diag& said, const rt::Cancelled&) {
        return slc::object_key(sl, options, said);
    };
    const auto find = [&] {
        rt::ShaderLibrary library(config, strings, diag);
        ok = library.find(name, SL_SHADER_surface, {}) != nullptr && ok;
    };
    find();
    return median_ms(101, find);
}

} // namespace

int main() {
    const base::TempDir dir("slc-bench");
    base::Diag diag;
    const std::string source = dir.path() + "/layered.sl";
    const std::string object = dir.path() + "/made.slo"; // not where the search would find it
    std::ofstream(source) << long_shader();
    slc::ObjectOptions native;
    native.native_only = true;
    native.index_dir = dir.path() + "/cache";
    std::ofstream(dir.path() + "/constants.h") << "#define LAYERS 20\n";
    std::ofstream(dir.path() + "/including.sl") << "#include \"constants.h\"\n" << long_shader();
    // The index does not trust files younger than two seconds (slc/key_index.h).
    std::this_thread::sleep_for(std::chrono::milliseconds(2100));
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
        median_ms(101, [&] { ok = slc::object_key(source, native, diag).has_value() && ok; });
    const double ms_cached = cached_ms(dir.path(), "layered", native, ok);
    const double ms_cached_includes = cached_ms(dir.path(), "including", native, ok);
    slc::ObjectOptions no_index = native;
    no_index.index_dir.clear();
    const double ms_preprocessed = median_ms(11, [&] {
        ok = slc::object_key(dir.path() + "/including.sl", no_index, diag).has_value() && ok;
    });
    const auto tools = slc::find_toolchain("", diag);
    const int lanes = slc::native_lanes();
    const auto compile = [&](const std::string& text) {
        return best_ms(7, [&] {
            ok = slc::build_shared_object(*tools, {{lanes, text}}, {}, "bench", {}, diag)
                     .has_value() &&
                 ok;
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
    print("shader from the cache, 150 lines", ms_cached, 2,
          "search, key, seal, dynamic linking; median of 101");
    print("shader from the cache, with #include", ms_cached_includes, 2,
          "the key comes from the index; median of 101");
    print("cache key, 150 lines", ms_key, 2, "part of the above; median of 101");
    print("cache key, with #include, no index", ms_preprocessed, 100,
          "the preprocessor runs; median of 11");
    print("sl_shader.h", ms_header, 50, "compile time it adds to an empty file");
    return 0;
}
