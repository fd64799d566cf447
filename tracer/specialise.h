// SPDX-License-Identifier: Apache-2.0
// Shaders made again for the parameters of their instances, while the frame renders (design.md,
// section 4). In: the frame's instances, how much of the frame is done, the time spent in each.
// Out: ShaderEntry::current() gives the special object from the moment it is there. The results of
// both are the same bits, so that moment changes no picture (docs/design/slc-speed.md, spd-001).
// What cannot be made is not missed: the general shader goes on.
#pragma once

#include "runtime/base/ticks.h"
#include "runtime/base/work_queue.h"
#include "tracer/lights.h"
#include "tracer/shading_classes.h"
#include "tracer/special_mode.h"

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

namespace trace {

class Specialiser {
public:
    struct Settings {
        SpecialMode mode = SpecialMode::Auto;
        int num_threads = 1;
        bool is_verbose = false;
        bool for_profile = false; // objects that count time by line; parameters stay parameters
        bool (*interrupted)() = nullptr; // may be null
    };
    // All outlive it.
    Specialiser(const Settings& settings, const ShadingClasses& classes, const LightSet& lights,
                rt::ShaderLibrary& library, base::Diag& diag);
    // The entries are general again. Nothing may be shading any more.
    ~Specialiser();
    Specialiser(const Specialiser&) = delete;
    Specialiser& operator=(const Specialiser&) = delete;

    // Called by any thread after each bucket: `done` of `total` are finished.
    void progress(std::size_t done, std::size_t total);

    [[nodiscard]] std::uint64_t num_special() const { return num_special_; }

private:
    using Clock = std::chrono::steady_clock;
    enum class State : std::uint8_t { General, Asked, Done };
    struct Candidate {
        const ShaderEntry* entry = nullptr;
        std::vector<int> kept; // parameters that primitives supply
        std::atomic<State> state{State::General};
        double refused_s = 0; // work that was to come when it did not pay
        std::unique_ptr<rt::ShaderInstance> instance;
    };

    void add(const ShaderEntry* entry, const std::vector<ParamOverride>& overrides);
    void make_all();
    void look(double share_done);
    void ask(Candidate& candidate, double work_s);
    void make(Candidate& candidate, std::optional<double> work_s);
    void publish(Candidate& candidate, const rt::ShaderObject& object);
    [[nodiscard]] bool pays(const rt::SpecialShader& special, double work_s) const;

    const Settings settings_;
    rt::ShaderLibrary& library_;
    base::Diag& diag_;
    base::TickRate tick_rate_;
    std::vector<std::unique_ptr<Candidate>> candidates_;
    std::mutex looking_; // one thread looks at a time
    Clock::time_point next_look_;
    std::atomic<int> num_asked_{0}; // waiting or being made
    std::atomic<std::uint64_t> num_special_{0};
    std::atomic<bool> is_ending_{false};
    base::WorkQueue queue_{1}; // last: its thread uses the rest
};

} // namespace trace
