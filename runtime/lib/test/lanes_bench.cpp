// SPDX-License-Identifier: Apache-2.0
// What built-in bodies cost and how exact they are: ns per point of the main ones at widths 1, 4
// and 8 (through planes and one indirect call per packet, so cheap ones show mostly that), 8-octave
// noise against intrinsics, and the largest error over dense sweeps against double precision. Out:
// JSON lines (docs/benchmarks.md).
#include "runtime/lib/test/fixture.h"
#include "runtime/lib/test/noise_loop.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <ctime>

namespace {

using namespace lanes_test;

double now_ns() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) * 1e9 + static_cast<double>(t.tv_nsec);
}

// Best of several rounds: what else runs on the machine counts less.
double best_ns(const std::function<void()>& work) {
    double best = 1e30;
    for (int round = 0; round < 15; round++) {
        const double start = now_ns();
        work();
        best = std::min(best, now_ns() - start);
    }
    return best;
}

void print(const std::string& name, double value, const char* unit, double limit,
           const std::string& note) {
    std::printf("{\"name\": \"%s\", \"value\": %.3g, \"unit\": \"%s\", ", name.c_str(), value,
                unit);
    if (limit > 0)
        std::printf("\"limit\": %g, ", limit);
    std::printf("\"better\": \"lower\", \"note\": \"%s\"}\n", note.c_str());
}

// --- speed

constexpr std::size_t num_points = 4096;

const lanes_case* find(const lanes_api& api, const char* name) {
    return std::find_if(api.cases, api.cases + api.num_cases,
                        [name](const lanes_case& c) { return c.name == std::string(name); });
}

double ns_per_point(const Width& width, const char* name) {
    const lanes_case* row = find(*width.api, name);
    Planes in, out(static_cast<std::size_t>(row->num_out), std::vector<float>(num_points));
    for (int k = 0; k < row->num_in; k++)
        in.push_back(scatter(0.1, 0.9, num_points, k));
    std::vector<const float*> args;
    std::vector<float*> results;
    for (const auto& plane : in)
        args.push_back(plane.data());
    for (auto& plane : out)
        results.push_back(plane.data());
    const int index = static_cast<int>(row - width.api->cases);
    const auto work = [&] {
        width.api->run(index, width.uniform, nullptr, args.data(), results.data(), num_points);
    };
    return best_ns(work) / num_points;
}

void measure_speed() {
    for (const char* name : {"sin",           "tan",
                             "atan2",         "exp",
                             "log",           "pow",
                             "erf",           "sqrt",
                             "mod",           "smoothstep",
                             "normalize",     "refract",
                             "fresnel",       "transform_m",
                             "inverse_m",     "to_hsv",
                             "from_hsv",      "spline_default",
                             "cellnoise_f_3", "noise_f_1",
                             "noise_f_2",     "noise_f_3",
                             "noise_f_4",     "noise_3_3",
                             "pnoise_f_3",    "sin_d",
                             "pow_d",         "smoothstep_d",
                             "mod_d",         "length_d",
                             "normalize_d",   "spline_default_d"}) {
        std::string note;
        double last = 0;
        for (const Width& width : widths()) {
            if (width.uniform && width.api->lanes == 8)
                continue;
            last = ns_per_point(width, name);
            char text[40];
            std::snprintf(text, sizeof text, "%s%.3g", note.empty() ? "width 1, 4, 8: " : ", ",
                          last);
            note += text;
        }
        print(std::string("built-in ") + name, last, "ns/point", 0, note);
    }
}

void measure_octaves() {
    const auto x = scatter(-20, 20, num_points, 0), y = scatter(-20, 20, num_points, 1),
               z = scatter(-20, 20, num_points, 2);
    std::vector<float> result(num_points), by_hand(num_points);
    const auto time = [&](auto function, std::vector<float>& to) {
        return best_ns([&] {
                   function(x.data(), y.data(), z.data(), to.data(), static_cast<int>(num_points));
               }) /
               num_points;
    };
    print("8-octave noise, uniform", time(noise_octaves_1, result), "ns/point", 0, "scalar code");
    print("8-octave noise, 4 lanes", time(noise_octaves_4, result), "ns/point", 0, "SSE2");
    if (!__builtin_cpu_supports("avx2"))
        return;
    const double lanes = time(noise_octaves_8, result), hand = time(noise_octaves_by_hand, by_hand);
    print("8-octave noise, 8 lanes", lanes, "ns/point", 0, "AVX2, noise as a library function");
    print("8-octave noise by hand", hand, "ns/point", 0, "intrinsics, inlined");
    char note[80];
    std::snprintf(note, sizeof note, "same bits: %s", result == by_hand ? "yes" : "NO");
    print("8-octave noise, library / intrinsics", lanes / hand, "ratio", 1.3, note);
}

// What differences cost beside the value alone.
void measure_differences() {
    if (!__builtin_cpu_supports("avx2"))
        return;
    const auto x = scatter(-20, 20, num_points, 0), y = scatter(-20, 20, num_points, 1),
               z = scatter(-20, 20, num_points, 2);
    std::vector<float> result(num_points);
    const int n = static_cast<int>(num_points);
    const double alone =
        best_ns([&] { noise_octaves_8(x.data(), y.data(), z.data(), result.data(), n); });
    for (const float step : {1e-5f, 0.1f}) {
        const auto ratio = [&](auto function) {
            return best_ns(
                       [&] { function(x.data(), y.data(), z.data(), result.data(), n, step); }) /
                   alone;
        };
        char note[120];
        std::snprintf(note, sizeof note, "a call each %.3g; three values, which cancel, %.3g",
                      ratio(noise_differences_apart), ratio(noise_differences_by_values));
        print("8-octave noise with both differences / without, step " +
                  std::string(step > 0.01f ? "0.1" : "1e-5"),
              ratio(noise_differences_together), "ratio", 0, note);
    }
}

// --- accuracy

struct Sweep {
    const char* name;
    double low, high; // of the first argument; all floats between, thinned
    double goal_ulps;
    double (*value)(double x, double y);
    double y_low = 0, y_high = 0; // of a second argument
};

const Sweep sweeps[] = {
    {"sin", -6400, 6400, 2, [](double x, double) { return std::sin(x); }},
    {"sin", 6400, 3e38, 2, [](double x, double) { return std::sin(x); }},
    {"cos", -6400, 6400, 2, [](double x, double) { return std::cos(x); }},
    {"cos", 6400, 3e38, 2, [](double x, double) { return std::cos(x); }},
    {"tan", -6400, 6400, 2, [](double x, double) { return std::tan(x); }},
    {"asin", -1, 1, 2, [](double x, double) { return std::asin(x); }},
    {"acos", -1, 1, 2, [](double x, double) { return std::acos(x); }},
    {"atan", -1e9, 1e9, 2, [](double x, double) { return std::atan(x); }},
    {"atan2", -100, 100, 2, [](double y, double x) { return std::atan2(y, x); }, -100, 100},
    {"exp", -103, 88.7, 2, [](double x, double) { return std::exp(x); }},
    {"log", 1.2e-38, 3e38, 2, [](double x, double) { return std::log(x); }},
    {"pow", 1e-6, 1e6, 4, [](double x, double y) { return std::pow(x, y); }, -6, 6},
    {"pow", 0.5, 2, 4, [](double x, double y) { return std::pow(x, y); }, -120, 120},
    {"sqrt", 0, 3e38, 0.5, [](double x, double) { return std::sqrt(x); }},
    {"inversesqrt", 1e-38, 3e38, 2, [](double x, double) { return 1 / std::sqrt(x); }},
    {"erf", -6, 6, 2, [](double x, double) { return std::erf(x); }},
    {"erfc", -6, 9, 4, [](double x, double) { return std::erfc(x); }},
};

// About n floats of [low, high], evenly spread over the representable ones.
std::vector<float> thinned(double low, double high, std::size_t n) {
    const auto key = [](float f) { // order of floats as order of integers
        const auto bits = std::bit_cast<std::int32_t>(f);
        return static_cast<std::int64_t>(bits < 0 ? INT32_MIN - bits : bits);
    };
    const std::int64_t first = key(static_cast<float>(low)), last = key(static_cast<float>(high));
    std::vector<float> v(n);
    for (std::size_t i = 0; i < n; i++) {
        const auto k =
            static_cast<std::int32_t>(first + (last - first) * static_cast<std::int64_t>(i) /
                                                  static_cast<std::int64_t>(n - 1));
        v[i] = std::bit_cast<float>(k < 0 ? INT32_MIN - k : k);
    }
    return v;
}

void measure_accuracy() {
    const std::size_t n = 2000000;
    for (const Sweep& s : sweeps) {
        Planes in{thinned(s.low, s.high, n)};
        if (s.y_low != s.y_high)
            in.push_back(scatter(s.y_low, s.y_high, n, 3));
        const Planes got = run(widths().back(), s.name, in, n);
        double worst = 0, at = 0, at_y = 0;
        for (std::size_t i = 0; i < n; i++) {
            const double x = in[0][i], y = in.size() > 1 ? in[1][i] : 0;
            const double error = ulps(got[0][i], s.value(x, y));
            if (error > worst)
                worst = error, at = x, at_y = y;
        }
        char name[80], note[80];
        std::snprintf(name, sizeof name, "error of %s on [%g, %g]", s.name, s.low, s.high);
        std::snprintf(note, sizeof note, "2,000,000 floats; worst at %.9g%s%.9g", at,
                      in.size() > 1 ? ", " : " ", at_y);
        print(name, worst, "ulp", s.goal_ulps, note);
    }
}

} // namespace

int main() {
    measure_octaves();
    measure_differences();
    measure_speed();
    measure_accuracy();
    return 0;
}
