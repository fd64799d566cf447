// SPDX-License-Identifier: Apache-2.0
// The backend that renders: finished worlds come in from the RIB reader, files and statistics
// leave.
#pragma once

#include "ribtools/backend.h"
#include "runtime/shader.h"
#include "tracer/frame.h"

#include <functional>
#include <string>
#include <vector>

namespace trace {

struct RendererConfig {
    RenderSettings settings;
    // How shaders are compiled and cached. Its search_path comes last: the standard shaders are
    // found whatever path a RIB sets.
    rt::ShaderLibrary::Config shaders;
    std::vector<std::string> shader_path_first; // -shaders
};

class Renderer : public rib::Backend {
public:
    Renderer(RendererConfig config, base::Diag& diag);
    ~Renderer() override;

    // False when reading should end: interrupted, or the environment failed.
    bool render(std::unique_ptr<rib::Scene> scene) override;
    bool make_texture(const rib::TextureRequest& request) override;

    // The file of worlds without Display from now on.
    void set_default_output(std::string file) { config_.settings.default_output = std::move(file); }

    [[nodiscard]] const Stats& stats() const { return stats_; }
    [[nodiscard]] Stats& stats() { return stats_; }
    [[nodiscard]] FrameResult result() const { return result_; } // the worst so far
    [[nodiscard]] int num_frames() const { return num_frames_; }

private:
    rt::ShaderLibrary& library_for(const rib::Options& options);

    RendererConfig config_;
    base::Diag& diag_;
    rt::StringTable strings_;
    // A library per search path met: objects stay loaded, and a path change cannot find an older
    // shader.
    std::vector<std::pair<std::vector<std::string>, std::unique_ptr<rt::ShaderLibrary>>> libraries_;
    Stats stats_;
    FrameResult result_ = FrameResult::Done;
    int num_frames_ = 0;
};

} // namespace trace
