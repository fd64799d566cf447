// SPDX-License-Identifier: Apache-2.0
#include "tracer/ray_levels.h"

#include "tracer/pixel_trace.h"

namespace trace {

RayLevels::Level::Level(RayLevels& all)
    : shader(all.frame_, all.camera_, all.classes_, nullptr, all.thread_),
      layers(all.frame_, all.classes_, nullptr, all.visibility_, shader, all.thread_),
      wave(all.frame_, layers, all.thread_) {}

RayLevels::RayLevels(const FrameContext& frame, const Camera& camera, const ShadingClasses& classes,
                     const VisibilityOptions& visibility, ThreadState& thread)
    : frame_(frame), camera_(camera), classes_(classes), visibility_(visibility), thread_(thread),
      options_(frame.scene), media_(frame.scene) {}

RayLevels::~RayLevels() = default;

RayLevels::Level& RayLevels::enter() {
    if (depth_ == levels_.size()) {
        levels_.push_back(std::make_unique<Level>(*this));
    }
    return *levels_[depth_++];
}

// No shader runs meanwhile, so the thread's lights are free.
void RayLevels::answer(std::span<ShadeJob* const> waiting) {
    Level& level = enter();
    level.wave.answer(waiting);
    leave();
}

DeeperShader::DeeperShader(ThreadState& thread) : thread_(thread), level_(thread.levels->enter()) {
    thread_.lights.swap(level_.lights);
    if (thread_.trace != nullptr) {
        traced_ = thread_.trace->batch();
    }
}

DeeperShader::~DeeperShader() {
    thread_.lights.swap(level_.lights);
    thread_.levels->leave();
    if (thread_.trace != nullptr) { // the shader that asked goes on
        thread_.trace->begin_batch(traced_);
    }
}

} // namespace trace
