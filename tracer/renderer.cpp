// SPDX-License-Identifier: Apache-2.0
#include "tracer/renderer.h"

#include "ribtools/search_path.h"
#include "tracer/shader_set.h"

#include <algorithm>
#include <filesystem>

namespace trace {

Renderer::Renderer(RendererConfig config, base::Diag& diag)
    : config_(std::move(config)), diag_(diag), library_(config_.shaders, strings_, diag) {}
Renderer::~Renderer() = default;

void Renderer::shader_named(const rib::ShaderCall& call, rib::ShaderRole role) {
    const bool is_there = role == rib::ShaderRole::Surface || !is_null_shader(call);
    if (is_there) {
        library_.prefetch(call.name, call.pos, *call.search_path);
    }
}

bool Renderer::render(std::unique_ptr<rib::Scene> scene) {
    ++num_frames_;
    if (scene->options.hider == "null") { // ri.md 6.5: no image
        return true;
    }
    say_what_is_done(scene->options);
    FrameResult result = render_recorded(*scene);
    if (!frame_statistics_.tell(scene->options, run_.frames.back())) {
        result = std::max(result, FrameResult::Failed);
    }
    result_ = std::max(result_, result);
    // Whatever spoilt this frame (a full disk, a directory that is not there) may spare the next.
    return result != FrameResult::Interrupted;
}

namespace {

using Clock = std::chrono::steady_clock;

double seconds_between(Clock::time_point from, Clock::time_point to) {
    return std::chrono::duration<double>(to - from).count();
}

const char* result_text(FrameResult result) {
    switch (result) {
    case FrameResult::Done:
        return "done";
    case FrameResult::Interrupted:
        return "interrupted";
    case FrameResult::Failed:
        return "failed";
    }
    return "";
}

std::array<std::uint64_t, 4> message_counts(const base::Diag& diag) {
    std::array<std::uint64_t, 4> counts{};
    for (std::size_t i = 0; i < counts.size(); ++i) {
        counts[i] = diag.count(static_cast<base::Severity>(i));
    }
    return counts;
}

} // namespace

// Worlds render while their file is read: a frame's time to read is what passed since the last.
FrameResult Renderer::render_recorded(const rib::Scene& scene) {
    FrameRecord frame;
    frame.stats.seconds[Phase::read] = seconds_between(read_since_, Clock::now());
    frame.file = run_.files.empty() ? "" : run_.files.back();
    frame.number = scene.options.frame;
    frame.is_numbered = scene.options.in_frame;
    frame.options = frame_options(scene.options);
    const FrameResult result = render_frame(scene, config_.settings,
                                            {library_, strings_, diag_, frame.stats,
                                             config_.profile_shaders ? &listing_ : nullptr,
                                             config_.keep_previews ? &frame.preview : nullptr});
    note_directories(scene);
    frame.result = result_text(result);
    add_library_stats(frame.stats);
    frame.stats.amounts[Amount::peak_bytes] = peak_memory_bytes();
    frame.num_messages = message_counts(diag_);
    for (std::size_t i = 0; i < frame.num_messages.size(); ++i) {
        const std::uint64_t all = frame.num_messages[i];
        frame.num_messages[i] -= messages_before_[i];
        messages_before_[i] = all;
    }
    run_.total += frame.stats;
    run_.frames.push_back(std::move(frame));
    read_since_ = Clock::now();
    return result;
}

// -v, or Option "runtime" "verbosity" "debug".
void Renderer::say_what_is_done(const rib::Options& options) {
    if (config_.is_verbose || verbosity_of(options) == Verbosity::Debug) {
        diag_.report(base::Severity::Info, base::Code::None, {},
                     "rendering " +
                         (options.in_frame ? "frame " + std::to_string(options.frame)
                                           : std::string("a picture")) +
                         ": " + std::to_string(options.xres) + " by " +
                         std::to_string(options.yres) + " pixels, " +
                         std::to_string(options.xsamples) + " by " +
                         std::to_string(options.ysamples) + " samples");
    }
}

// Where sources of shaders may lie, for the profile.
void Renderer::note_directories(const rib::Scene& scene) {
    for (const rib::ShaderCall& call : scene.shaders) {
        for (const std::string& directory : *call.search_path) {
            if (config_.profile_shaders &&
                std::ranges::find(shader_directories_, directory) == shader_directories_.end()) {
                shader_directories_.push_back(directory);
            }
        }
    }
}

const ShaderListing& Renderer::listing() {
    std::vector<std::string> directories = config_.shaders.path_first;
    for (const auto* more : {&shader_directories_, &config_.shaders.search_path}) {
        directories.insert(directories.end(), more->begin(), more->end());
    }
    listing_.find_sources(directories);
    return listing_;
}

// What the library did since the frame before: shaders are compiled while a scene is read.
void Renderer::add_library_stats(Stats& stats) {
    const rt::LibraryStats now = library_.stats(), &before = library_before_;
    stats.counters[Counter::shader_objects] += now.objects - before.objects;
    stats.counters[Counter::shader_hits] += now.cache_hits - before.cache_hits;
    stats.counters[Counter::shader_misses] += now.cache_misses - before.cache_misses;
    stats.counters[Counter::shader_compiles] += now.compiled - before.compiled;
    stats.counters[Counter::special_compiles] += now.compiled_special - before.compiled_special;
    stats.parts[Part::shader_special] += now.special_seconds - before.special_seconds;
    stats.parts[Part::shader_search] += now.search_seconds - before.search_seconds;
    stats.parts[Part::shader_compile] += now.compile_seconds - before.compile_seconds;
    stats.parts[Part::shader_load] += now.load_seconds - before.load_seconds;
    library_before_ = now;
}

void Renderer::set_file(std::string name, std::string default_output) {
    run_.files.push_back(std::move(name));
    config_.settings.default_output = std::move(default_output);
}

RunRecord& Renderer::finish() {
    const auto now = Clock::now();
    run_.total.seconds[Phase::read] += seconds_between(read_since_, now);
    read_since_ = now;
    run_.seconds = seconds_between(start_, now);
    run_.messages = diag_.records();
    run_.machine = this_machine();
    return run_;
}

namespace {

// As written, or in a directory of the texture path.
bool source_exists(const std::string& name, const rib::Options& options) {
    std::error_code error;
    if (std::filesystem::exists(name, error)) {
        return true;
    }
    const std::vector<std::string> path = rib::search_directories(options, "texture");
    return std::any_of(path.begin(), path.end(), [&](const std::string& directory) {
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
