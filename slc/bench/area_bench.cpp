// SPDX-License-Identifier: Apache-2.0
// What area operators cost: shaders with filter widths by differences at the auxiliary points
// against the same shaders with a constant width, emitted code, one run, batches of 256 points.
// [Gritz96] claims "very little overhead". Prints JSON lines (docs/benchmarks.md,
// docs/derivatives.md). In: area_operators.sl, which holds one shader per PATTERN.
#include "runtime/base/temp_dir.h"
#include "slc/driver.h"
#include "slc/emit_runner.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint32_t num_points = 256;

// One compiled shader and a batch of it.
class Shader {
public:
    Shader(slc::EmitRunner& runner, const std::string& source, const std::string& pattern,
           bool by_operators) {
        slc::ObjectOptions options;
        options.native_only = true;
        options.front.defines = {"PATTERN=" + pattern};
        if (!by_operators) {
            options.front.defines.emplace_back("CONSTANT_WIDTH=1");
        }
        const std::string object = dir_.path() + "/area_operators.slo";
        if (!slc::compile_to_object(source, object, options, runner.diag)) {
            return;
        }
        shader_ = runner.library.load(object, {});
        if (shader_ == nullptr) {
            return;
        }
        instance_ = std::make_unique<rt::ShaderInstance>(
            *shader_, std::span<const rt::BoundValue>(), runner.services, nullptr, runner.strings,
            runner.diag);
        batch_.begin(*instance_, num_points);
        fill();
        batch_.run({&runner.services, nullptr});
    }
    [[nodiscard]] bool ok() const { return shader_ != nullptr; }

    void run() {
        const sl_variant& variant = shader_->variant();
        const auto lanes = static_cast<std::uint32_t>(variant.lanes);
        for (std::uint32_t first = 0; first < num_points; first += lanes) {
            variant.shade(&batch_.raw(), first, lanes, nullptr);
        }
    }

private:
    base::TempDir dir_{"area-bench"};
    const rt::ShaderObject* shader_ = nullptr;
    std::unique_ptr<rt::ShaderInstance> instance_;
    rt::ShadeBatch batch_;

    // A pixel's step of about 0.01 on a surface of size 10.
    void fill() {
        for (std::uint32_t i = 0; i < num_points; ++i) {
            const float f = static_cast<float>(i);
            for (int c = 0; c < 3; ++c) {
                const float k = static_cast<float>(c);
                set(SL_VAR_P, c, i, 5 * std::sin(0.37F * f + k), 0.01F * std::cos(f + k));
                set(SL_VAR_N, c, i, std::cos(0.11F * f + 2 * k), 0.002F * std::sin(f + k));
                set(SL_VAR_I, c, i, std::sin(0.05F * f - k) + 0.2F, 0.01F * std::cos(f + k));
                set(SL_VAR_Cs, c, i, 0.3F + 0.2F * k, 0);
                set(SL_VAR_Os, c, i, 1, 0);
            }
            set(SL_VAR_s, 0, i, 0.01F * f, 0.003F);
            set(SL_VAR_t, 0, i, 0.5F + 0.4F * std::sin(f), 0.002F);
            set(SL_VAR_u, 0, i, 0.01F * f, 0.003F);
            set(SL_VAR_v, 0, i, 0.5F, 0.002F);
            set(SL_VAR_du, 0, i, 0.003F, 0);
            set(SL_VAR_dv, 0, i, 0.002F, 0);
        }
    }
    void set(sl_variable id, int component, std::uint32_t i, float value, float difference) {
        if (float* plane = batch_.plane(id, component)) {
            plane[i] = value;
        }
        if (float* plane = batch_.aux_u(id, component)) {
            plane[i] = difference;
        }
        if (float* plane = batch_.aux_v(id, component)) {
            plane[i] = -0.7F * difference;
        }
    }
};

// Nanoseconds per point of both, best of many samples taken in turn.
std::array<double, 2> ns_per_point(Shader& a, Shader& b) {
    constexpr int repeats = 20;
    std::array<double, 2> best{1e30, 1e30};
    for (int sample = 0; sample < 100; ++sample) {
        for (std::size_t which = 0; which < 2; ++which) {
            const auto start = Clock::now();
            for (int i = 0; i < repeats; ++i) {
                (which == 0 ? a : b).run();
            }
            const std::chrono::duration<double, std::nano> elapsed = Clock::now() - start;
            best[which] = std::min(best[which], elapsed.count() / (repeats * double(num_points)));
        }
    }
    return best;
}

constexpr const char* patterns[] = {"STRIPES", "BRICKS", "MARBLE", "BUMPS", "PLASTIC"};

} // namespace

int main(int argc, char** argv) {
    const std::string source = argc > 1 ? argv[1] : "slc/bench/area_operators.sl";
    slc::EmitRunner runner;
    for (const char* pattern : patterns) {
        Shader with(runner, source, pattern, true), without(runner, source, pattern, false);
        if (!with.ok() || !without.ok()) {
            return 1;
        }
        const auto [with_ns, without_ns] = ns_per_point(with, without);
        std::printf("{\"name\": \"area operators, %s: with / without\", \"value\": %.3g, \"unit\": "
                    "\"ratio\", "
                    "\"better\": \"lower\", \"note\": \"%.3g and %.3g ns/point\"}\n",
                    pattern, with_ns / without_ns, with_ns, without_ns);
    }
    return 0;
}
