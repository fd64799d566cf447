// SPDX-License-Identifier: Apache-2.0
#include "tracer/renderer.h"

#include <algorithm>
#include <filesystem>

namespace trace {

Renderer::Renderer(RendererConfig config, base::Diag& diag)
    : config_(std::move(config)), diag_(diag) {}
Renderer::~Renderer() = default;

// -shaders, then what the RIB says, then the installed shaders; each directory once.
rt::ShaderLibrary& Renderer::library_for(const rib::Options& options) {
    std::vector<std::string> path;
    const auto add = [&path](const std::vector<std::string>& directories) {
        for (const std::string& directory : directories) {
            if (std::find(path.begin(), path.end(), directory) == path.end()) {
                path.push_back(directory);
            }
        }
    };
    add(config_.shader_path_first);
    if (const auto from_rib = options.search_paths.find("shader");
        from_rib != options.search_paths.end()) {
        add(from_rib->second);
    }
    add(config_.shaders.search_path);
    const auto it = std::find_if(libraries_.begin(), libraries_.end(),
                                 [&](const auto& item) { return item.first == path; });
    if (it != libraries_.end()) {
        return *it->second;
    }
    rt::ShaderLibrary::Config config = config_.shaders;
    config.search_path = path;
    libraries_.emplace_back(
        path, std::make_unique<rt::ShaderLibrary>(std::move(config), strings_, diag_));
    return *libraries_.back().second;
}

bool Renderer::render(std::unique_ptr<rib::Scene> scene) {
    ++num_frames_;
    if (scene->options.hider == "null") { // ri.md 6.5: no image
        return true;
    }
    Stats frame_stats;
    const FrameResult result = render_frame(
        *scene, config_.settings, {library_for(scene->options), strings_, diag_, frame_stats});
    stats_ += frame_stats;
    if (result != FrameResult::Done) {
        result_ = result;
    }
    return result == FrameResult::Done;
}

namespace {

// As written, or in a directory of the texture path.
bool source_exists(const std::string& name, const rib::Options& options) {
    std::error_code error;
    if (std::filesystem::exists(name, error)) {
        return true;
    }
    const auto path = options.search_paths.find("texture");
    return path != options.search_paths.end() &&
           std::any_of(path->second.begin(), path->second.end(), [&](const std::string& directory) {
               return std::filesystem::exists(std::filesystem::path(directory) / name, error);
           });
}

} // namespace

bool Renderer::make_texture(const rib::TextureRequest& request) {
    for (std::size_t i = 0; i + 1 < request.files.size(); ++i) { // the last one is the result
        if (!source_exists(request.files[i], request.options)) {
            diag_.report(base::Severity::Error, base::Code::NoFile, request.pos,
                         request.kind + ": cannot read " + request.files[i] +
                             "; no texture is made");
            return true;
        }
    }
    diag_.report_once("texture:" + request.kind, base::Severity::Info, base::Code::Unimplement,
                      request.pos,
                      request.kind + ": textures are not made yet; the request is ignored");
    return true;
}

} // namespace trace
