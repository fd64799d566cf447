// SPDX-License-Identifier: Apache-2.0
// The backend that renders: finished worlds come in from the RIB reader, files and statistics
// leave.
#pragma once

#include "ribtools/backend.h"
#include "runtime/shader.h"
#include "tracer/frame.h"
#include "tracer/frame_statistics.h"
#include "tracer/run_record.h"
#include "tracer/shader_profile.h"
#include "tracer/texture_make.h"
#include "tracer/textures.h"

#include <array>
#include <chrono>
#include <functional>
#include <string>
#include <vector>

namespace trace {

struct RendererConfig {
    RenderSettings settings;
    // How shaders are found, compiled and cached. The path of -shaders comes first, the standard
    // shaders last, whatever path a RIB sets between them.
    rt::ShaderLibrary::Config shaders;
    bool keep_previews = false; // small pictures of the frames, for --report
    bool is_verbose = false;    // -v
    bool profile_shaders = false;
};

class Renderer : public rib::Backend {
public:
    Renderer(RendererConfig config, base::Diag& diag);
    ~Renderer() override;

    void shader_named(const rib::ShaderCall& call, rib::ShaderRole role) override;
    // False when reading should end: interrupted.
    bool render(std::unique_ptr<rib::Scene> scene) override;
    bool make_texture(const rib::TextureRequest& request) override;

    // Ends what goes on in the background: the process may end any moment after it.
    void stop() { library_.stop(); }

    // The file that is read from now on, and that of its worlds without Display.
    void set_file(std::string name, std::string default_output);
    // No more frames come. What was done, for reports.
    RunRecord& finish();

    // Time by line of the shaders, of all frames so far, with the sources that were found.
    [[nodiscard]] const ShaderListing& listing();

    [[nodiscard]] FrameResult result() const { return result_; } // the worst so far
    [[nodiscard]] int num_frames() const { return num_frames_; }

private:
    RendererConfig config_;
    base::Diag& diag_;
    rt::StringTable strings_;
    rt::ShaderLibrary library_;

    FrameResult render_recorded(const rib::Scene& scene);
    // False: one is missing, which was said.
    bool find_sources(const rib::TextureRequest& request, MakeRequest& make);

    void note_directories(const rib::Scene& scene);
    void add_library_stats(Stats& stats);
    void say_what_is_done(const rib::Options& options);

    Textures textures_;
    RunRecord run_;
    ShaderListing listing_;
    std::vector<std::string> shader_directories_; // of the frames' search paths
    FrameStatistics frame_statistics_{diag_};
    rt::LibraryStats library_before_; // when the frame before was done
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    std::chrono::steady_clock::time_point read_since_ = start_;
    std::array<std::uint64_t, 4> messages_before_{};
    FrameResult result_ = FrameResult::Done;
    int num_frames_ = 0;
};

} // namespace trace
