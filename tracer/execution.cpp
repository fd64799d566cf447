// SPDX-License-Identifier: Apache-2.0
#include "tracer/execution.h"

#include "tracer/light_run.h"
#include "tracer/pattern_cache.h"
#include "tracer/ray_levels.h"
#include "tracer/shade_job.h"
#include "tracer/shader_set.h"

#include <algorithm>

namespace trace {

ThreadState::ThreadState() = default;
ThreadState::~ThreadState() = default;

std::uint32_t Execution::lanes() const {
    return static_cast<std::uint32_t>(running.instance->shader().variant().lanes);
}

void report_suspended(const Execution& execution) {
    report_shader(execution, base::Severity::Warning, 0,
                  "waits for rays where none can be traced; what follows is not computed");
}

void report_shader(const Execution& execution, base::Severity severity, int line,
                   std::string_view text, std::string_view file) {
    const ShaderEntry& shader = execution.running;
    // While parameters are bound there is no instance yet: the call's place has to do.
    base::SourcePos pos = shader.pos;
    if (shader.instance && line > 0) {
        pos = {
            execution.frame.diag.file_id(file.empty() ? shader.object().source : std::string(file)),
            static_cast<std::uint32_t>(line), 0};
    }
    const std::string message = "shader \"" + shader.name + "\": " + std::string(text);
    execution.frame.diag.report_once(message, severity, base::Code::None, pos, message);
}

std::uint32_t max_loop_steps(const rib::Options& options) {
    const auto it = options.user.find("limits:loopsteps");
    if (it == options.user.end()) {
        return FrameContext::default_loop_steps;
    }
    const rib::Param& given = it->second;
    const double steps = !given.ints.empty()     ? given.ints.front()
                         : !given.floats.empty() ? static_cast<double>(given.floats.front())
                                                 : FrameContext::default_loop_steps;
    return static_cast<std::uint32_t>(std::clamp(steps, 1.0, 4e9));
}

} // namespace trace
