// SPDX-License-Identifier: Apache-2.0
// What waiting for rays costs beside the rays: a packet is suspended and resumed with an answer
// that takes no time. In: rays.sl. Out: JSON lines (docs/benchmarks.md), nanoseconds per packet for
// each trace (slope from 0 to 4 calls), and of three shaders as scenes have them, whose frames are
// measured too.
#include "runtime/base/temp_dir.h"
#include "slc/driver.h"
#include "slc/emit_runner.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <new>
#include <span>
#include <string>

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint32_t num_points = 256;

class Shader {
public:
    Shader(slc::EmitRunner& runner, const std::string& source, const std::string& define) {
        slc::ObjectOptions options;
        options.native_only = true;
        options.front.defines = {define};
        const std::string object = dir_.path() + "/rays.slo";
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
        batch_.bind({&runner.services, nullptr});
        fill();
        frame_ = static_cast<sl_frame*>(
            ::operator new (std::max<std::size_t>(frame_size(), 64), std::align_val_t{64}));
    }
    ~Shader() { ::operator delete (frame_, std::align_val_t{64}); }
    Shader(const Shader&) = delete;
    Shader& operator=(const Shader&) = delete;
    [[nodiscard]] bool ok() const { return shader_ != nullptr; }
    [[nodiscard]] std::size_t frame_size() const { return shader_->variant().frame_size; }

    // Returns how often packets were suspended.
    int run() {
        const sl_variant& variant = shader_->variant();
        const auto lanes = static_cast<std::uint32_t>(variant.lanes);
        int suspended = 0;
        for (std::uint32_t first = 0; first < num_points; first += lanes) {
            frame_->state = 0;
            while (variant.shade(&batch_.raw(), first, lanes, frame_) == SL_SUSPENDED) {
                ++suspended;
            }
        }
        return suspended;
    }
    [[nodiscard]] int num_packets() const {
        return static_cast<int>(num_points) / shader_->variant().lanes;
    }

private:
    base::TempDir dir_{"trace-bench"};
    const rt::ShaderObject* shader_ = nullptr;
    std::unique_ptr<rt::ShaderInstance> instance_;
    rt::ShadeBatch batch_;
    sl_frame* frame_ = nullptr;

    void fill() {
        for (std::uint32_t i = 0; i < num_points; ++i) {
            for (const sl_variable id :
                 {SL_VAR_P, SL_VAR_N, SL_VAR_I, SL_VAR_Ng, SL_VAR_Cs, SL_VAR_Os}) {
                for (int c = 0; c < 3 && batch_.has(id); ++c) {
                    const auto k = static_cast<float>(c + 3 * id);
                    batch_.plane(id, c)[i] = 1.1F + std::sin(0.37F * static_cast<float>(i) + k);
                }
            }
        }
    }
};

// Nanoseconds per packet, best of many samples.
double ns_per_packet(Shader& shader) {
    constexpr int repeats = 20;
    double best = 1e30;
    for (int sample = 0; sample < 200; ++sample) {
        const auto start = Clock::now();
        for (int i = 0; i < repeats; ++i) {
            shader.run();
        }
        const std::chrono::duration<double, std::nano> elapsed = Clock::now() - start;
        best = std::min(best, elapsed.count() / (repeats * shader.num_packets()));
    }
    return best;
}

void print(const std::string& name, double value, const char* unit, const std::string& note) {
    std::printf("{\"name\": \"waiting for rays, %s\", \"value\": %.3g, \"unit\": \"%s\", "
                "\"better\": \"lower\", \"note\": \"%s\"}\n",
                name.c_str(), value, unit, note.c_str());
}

} // namespace

int main(int argc, char** argv) {
    const std::string source = argc > 1 ? argv[1] : "slc/bench/rays.sl";
    slc::EmitRunner runner;
    double ns[2] = {0, 0};
    for (const int traces : {0, 4}) {
        Shader shader(runner, source, "TRACES=" + std::to_string(traces));
        if (!shader.ok()) {
            return 1;
        }
        ns[traces / 4] = ns_per_packet(shader);
    }
    print("suspend and resume", (ns[1] - ns[0]) / 4, "ns/packet",
          "4 calls of trace against none, " + std::to_string(ns[1]) + " and " +
              std::to_string(ns[0]) + " ns");
    for (const char* name : {"MIRROR", "GLASS", "LAYERED"}) {
        Shader shader(runner, source, std::string(name) + "=1");
        if (!shader.ok()) {
            return 1;
        }
        const double per_packet = double(shader.run()) / shader.num_packets();
        print(std::string("frame of ") + name, double(shader.frame_size()), "bytes",
              "the query is " + std::to_string(sizeof(sl_frame)));
        print(name, ns_per_packet(shader), "ns/packet",
              std::to_string(per_packet) + " suspensions per packet");
    }
    return 0;
}
