// SPDX-License-Identifier: Apache-2.0
// Speed of emitted code: eight octaves of noise and a Phong highlight (noise_phong.sl) against the
// same computation by hand in lanes and in scalar C, in one process, batches of 256 points, one
// thread. Prints JSON lines (docs/benchmarks.md).
#include "runtime/base/file.h"
#include "slc/bench/noise_phong.h"
#include "slc/driver.h"
#include "slc/emit_runner.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint32_t num_points = 256;

// Nanoseconds per point of several ways to do the same, each the best of many samples taken in
// turn: what else runs on the machine only adds time.
std::vector<double> ns_per_point(const std::vector<std::function<void()>>& ways) {
    constexpr int repeats = 40;
    std::vector<double> best(ways.size(), 1e30);
    for (int sample = 0; sample < 100; ++sample) {
        for (std::size_t way = 0; way < ways.size(); ++way) {
            const auto start = Clock::now();
            for (int i = 0; i < repeats; ++i) {
                ways[way]();
            }
            const std::chrono::duration<double, std::nano> elapsed = Clock::now() - start;
            best[way] = std::min(best[way], elapsed.count() / (repeats * double(num_points)));
        }
    }
    return best;
}

void fill(rt::ShadeBatch& batch) {
    for (std::uint32_t i = 0; i < num_points; ++i) {
        const float f = static_cast<float>(i);
        for (int c = 0; c < 3; ++c) {
            const float k = static_cast<float>(c);
            batch.plane(SL_VAR_P, c)[i] = 10 * std::sin(0.37F * f + k);
            batch.plane(SL_VAR_N, c)[i] = std::cos(0.11F * f + 2 * k);
            batch.plane(SL_VAR_I, c)[i] = std::sin(0.05F * f - k) + 0.2F;
            batch.plane(SL_VAR_Cs, c)[i] = 0.3F + 0.2F * k;
            batch.plane(SL_VAR_Os, c)[i] = 1;
        }
    }
}

double largest_difference(const float* a, const float* b, std::size_t n) {
    double worst = 0;
    for (std::size_t i = 0; i < n; ++i) {
        worst = std::max(worst, std::abs(double(a[i]) - double(b[i])));
    }
    return worst;
}

void print(const char* name, double value, const char* unit, double limit, const char* better,
           double error) {
    std::printf("{\"name\": \"%s\", \"value\": %.3f, \"unit\": \"%s\", ", name, value, unit);
    if (limit > 0) {
        std::printf("\"limit\": %g, \"better\": \"%s\", ", limit, better);
    }
    std::printf(
        "\"error\": \"%.1e\", \"note\": \"8 octaves of noise and Phong, 256 points, one core\"}\n",
        error);
}

} // namespace

int main(int argc, char** argv) {
    const std::string source = argc > 1 ? argv[1] : "slc/bench/noise_phong.sl";
    slc::EmitRunner runner;
    const slc::Unit unit = slc::compile_file(source, {}, runner.diag);
    if (!unit.ok() || unit.programs.empty()) {
        return 1;
    }
    const slc::Program& program = unit.programs.front();
    const rt::ShaderObject* shader =
        runner.build(program, slc::analyse(program), {slc::native_lanes(), 2});
    if (!shader) {
        return 1;
    }
    const rt::ShaderInstance instance(*shader, {}, runner.services, nullptr, runner.strings,
                                      runner.diag);
    rt::ShadeBatch batch;
    batch.begin(instance, num_points);
    fill(batch);
    batch.run({&runner.services, nullptr});
    const sl_variant& variant = shader->variant();
    const auto run_emitted = [&] {
        for (std::uint32_t first = 0; first < num_points;
             first += static_cast<std::uint32_t>(variant.lanes)) {
            variant.shade(&batch.raw(), first, static_cast<std::uint32_t>(variant.lanes), nullptr);
        }
    };
    const noise_phong_in in = {batch.plane(SL_VAR_P),
                               batch.plane(SL_VAR_N),
                               batch.plane(SL_VAR_I),
                               batch.plane(SL_VAR_Cs),
                               batch.plane(SL_VAR_Os),
                               0.1F,
                               0.6F,
                               0.3F,
                               20,
                               batch.stride(),
                               num_points};
    alignas(64) static float Ci[2][3 * num_points];
    alignas(64) static float Oi[3 * num_points];
    rt::ShadeBatch empty;
    const std::vector<double> ns = ns_per_point(
        {run_emitted, [&] { noise_phong_lanes(&in, Ci[0], Oi); },
         [&] { noise_phong_scalar(&in, Ci[1], Oi); }, [&] { empty.begin(instance, num_points); }});
    const double emitted = ns[0];
    const double by_hand = ns[1];
    const double scalar = ns[2];
    const double setup = ns[3];
    const double hand_error = largest_difference(Ci[0], batch.plane(SL_VAR_Ci), 3 * num_points);
    const double scalar_error = largest_difference(Ci[1], batch.plane(SL_VAR_Ci), 3 * num_points);

    print("emitted shader code", emitted, "ns/point", 0, "lower", 0);
    print("emitted code / hand-written lanes", emitted / by_hand, "ratio", 1.5, "lower",
          hand_error);
    print("scalar C / emitted code", scalar / emitted, "ratio", 5, "higher", scalar_error);
    print("batch set-up", setup, "ns/point", 0, "lower", 0);
    return 0;
}
