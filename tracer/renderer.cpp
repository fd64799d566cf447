// SPDX-License-Identifier: Apache-2.0
#include "tracer/renderer.h"

#include "ribtools/search_path.h"
#include "tracer/shader_set.h"

#include <algorithm>
#include <optional>

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
    const FrameResult result = render_frame(
        scene, config_.settings,
        {library_, strings_, diag_, frame.stats, config_.profile_shaders ? &listing_ : nullptr,
         config_.keep_previews ? &frame.preview : nullptr, &textures_});
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

struct MakeRow {
    std::string_view request;
    MapKind kind;
};
constexpr MakeRow make_rows[] = {
    {"MakeTexture", MapKind::Texture},
    {"MakeBump", MapKind::Texture},
    {"MakeLatLongEnvironment", MapKind::LatLong},
    {"MakeCubeFaceEnvironment", MapKind::Cube},
    {"MakeShadow", MapKind::Shadow},
    {"MakeOcclusion", MapKind::Occlusion},
    {"MakeBrickMap", MapKind::Points},
};

// The order of arguments is that of ri_requests.def: strings end with the filter, after the wrap
// modes; the field of view of a cube comes first among the numbers.
MakeRequest make_request(const rib::TextureRequest& request, MapKind kind) {
    MakeRequest make;
    make.kind = kind;
    make.sources.assign(request.files.begin(), request.files.end() - 1);
    make.target = request.files.back();
    if (!request.strings.empty()) {
        make.filter = request.strings.back();
    }
    if (request.strings.size() == 3) {
        make.smode = request.strings[0];
        make.tmode = request.strings[1];
    }
    if (kind == MapKind::Cube && !request.floats.empty()) {
        make.fov_deg = static_cast<double>(request.floats.front());
    }
    return make;
}

} // namespace

bool Renderer::find_sources(const rib::TextureRequest& request, MakeRequest& make) {
    const std::vector<std::string> path = rib::search_directories(request.options, "texture");
    for (std::string& source : make.sources) {
        const std::optional<std::string> found = find_map(source, path);
        if (!found) {
            diag_.report(base::Severity::Error, base::Code::NoFile, request.pos,
                         request.kind + ": cannot read " + source + "; " + make.target +
                             " is not made");
            return false;
        }
        source = *found;
    }
    return true;
}

bool Renderer::make_texture(const rib::TextureRequest& request) {
    const auto* row =
        std::ranges::find(make_rows, std::string_view(request.kind), &MakeRow::request);
    if (row == std::end(make_rows) || request.files.size() < 2) {
        return false;
    }
    MakeRequest make = make_request(request, row->kind);
    if (!find_sources(request, make)) {
        return true;
    }
    const MakeOutcome outcome = make_map(make);
    for (const std::string& note : outcome.notes) {
        diag_.report(base::Severity::Warning, base::Code::BadToken, request.pos,
                     request.kind + ": " + note);
    }
    if (!outcome.made) {
        diag_.report(outcome.environment ? base::Severity::Severe : base::Severity::Error,
                     outcome.environment ? base::Code::System : base::Code::BadFile, request.pos,
                     request.kind + ": " + outcome.error + "; " + make.target + " is not made");
        result_ = outcome.environment ? FrameResult::Failed : result_;
        return true;
    }
    textures_.changed(make.target);
    if (config_.is_verbose || verbosity_of(request.options) == Verbosity::Debug) {
        diag_.report(base::Severity::Info, base::Code::None, request.pos,
                     request.kind + ": made " + make.target);
    }
    return true;
}

} // namespace trace
