// SPDX-License-Identifier: Apache-2.0
// The program render (and rendrib): RIB files in, pictures out. Joins the reader, the compiler and
// the renderer; what they do is in their libraries. Exit codes: 0 done, 1 errors in the input, 2
// wrong usage, 3 the environment failed.
#include "ribtools/reader.h"
#include "runtime/base/diag.h"
#include "runtime/base/file.h"
#include "runtime/base/interrupt.h"
#include "runtime/base/module.h"
#include "runtime/base/parallel.h"
#include "runtime/base/search_path.h"
#include "slc/driver.h"
#include "tracer/display.h"
#include "tracer/live_display.h"
#include "tracer/merge.h"
#include "tracer/options.h"
#include "tracer/renderer.h"
#include "tracer/version.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <unistd.h>
#include <vector>

namespace {

namespace fs = std::filesystem;

enum ExitCode { exit_done = 0, exit_input = 1, exit_usage = 2, exit_environment = 3 };

// --- where things are

// Installed: dist/bin/render and dist/share/perigee/shaders; in the build tree shaders lie beside
// this folder.
std::vector<std::string> installed_shaders() {
    std::vector<std::string> found;
    const fs::path here = base::program_directory();
    for (const fs::path& directory :
         {here / ".." / "share" / "perigee" / "shaders", here / ".." / "shaders"}) {
        std::error_code error;
        if (!here.empty() && fs::is_directory(directory, error)) {
            found.push_back(directory.lexically_normal().string());
        }
    }
    return found;
}

std::vector<std::string> directories_from(const char* variable) {
    const char* value = std::getenv(variable);
    return value != nullptr ? base::expand_search_path(value) : std::vector<std::string>();
}

std::vector<std::string> default_shader_path() {
    std::vector<std::string> path = directories_from("SHADERS");
    path.insert(path.begin(), ".");
    const std::vector<std::string> installed = installed_shaders();
    path.insert(path.end(), installed.begin(), installed.end());
    for (const std::string& home : directories_from("BMRTHOME")) { // of the user's old installation
        path.push_back(home + "/shaders");
    }
    return path;
}

// --- configuration

void set_integer(rib::Options& options, const std::string& name, int value) {
    rib::Param& p = options.user[name];
    p.name = name;
    p.decl = {rib::StorageClass::Uniform, rib::ParamType::Integer, 1, false};
    p.ints = {value};
}

rib::Options rib_defaults(const trace::RenderOptions& options) {
    rib::Options defaults;
    if (options.res) {
        std::tie(defaults.xres, defaults.yres) = *options.res;
    }
    if (options.samples) {
        std::tie(defaults.xsamples, defaults.ysamples) = *options.samples;
    }
    if (options.variance) {
        defaults.pixel_variance = options.variance->variance;
        set_integer(defaults, "render:minsamples", options.variance->least);
        set_integer(defaults, "render:maxsamples", options.variance->most);
    }
    return defaults;
}

// -o names the picture: the first display that is no shadow map. Those, which later requests of the
// RIB look for by name, and further displays stay as they are.
void rename_picture(std::vector<rib::Display>& displays, const std::string& file) {
    const auto picture = std::ranges::find_if_not(displays, trace::writes_depth_map);
    if (picture != displays.end()) {
        *picture = trace::default_display(file, picture->mode);
    } else if (displays.empty()) {
        displays = {trace::default_display(file, "rgba")};
    }
}

void override_options(const trace::RenderOptions& options, rib::Options& rib_options) {
    if (options.crop) {
        rib_options.crop = *options.crop;
    }
    if (!options.output.empty()) {
        rename_picture(rib_options.displays,
                       trace::frame_file_name(options.output, rib_options.frame));
    }
}

// Option "runtime" "verbosity"; -silent stands above it.
void obey_verbosity(const trace::RenderOptions& options, trace::Verbosity verbosity,
                    base::Diag& diag) {
    const bool is_silent = options.silent || verbosity == trace::Verbosity::Silent;
    diag.set_threshold(is_silent ? base::Severity::Error : base::Severity::Info);
}

rib::Config reader_config(const trace::RenderOptions& options, base::Diag& diag) {
    rib::Config config;
    config.default_paths["shader"] = default_shader_path();
    config.default_paths["texture"] = directories_from("TEXTURES");
    config.default_paths["archive"] = directories_from("ARCHIVES");
    config.default_paths["procedural"] = directories_from("PROCEDURALS");
    config.default_paths["display"] = directories_from("DISPLAYS");
    config.allow_programs = options.allow_programs;
    config.interrupted = base::is_interrupted;
    config.defaults = rib_defaults(options);
    config.override_options = [&options, &diag](rib::Options& o) {
        override_options(options, o);
        obey_verbosity(options, trace::verbosity_of(o), diag);
    };
    config.on_option = [&options, &diag](std::string_view name, const rib::Param& value) {
        if (name == "runtime:verbosity") {
            obey_verbosity(options, trace::verbosity_of(&value), diag);
        }
    };
    config.wants_world = [&options](const rib::Options& o) {
        return !o.in_frame || trace::wants_frame(options, o.frame);
    };
    return config;
}

// Shaders found as source are compiled for this machine only.
slc::ObjectOptions compile_options(const std::string& index_dir, const rt::Cancelled& cancelled,
                                   base::ShadeopLibrary& shadeops) {
    slc::ObjectOptions options;
    options.native_only = true;
    options.index_dir = index_dir;
    options.front.cancelled = cancelled;
    options.front.standard_headers = slc::standard_headers();
    slc::use_shadeops(options, shadeops);
    return options;
}

// Seconds the C compiler takes: what an empty shader costs, and more for each statement (measured
// by the benchmark "special": docs/benchmarks.md).
double compile_seconds(std::size_t num_statements) {
    return 0.06 + 0.0004 * static_cast<double>(num_statements);
}

// The compiler's order for an object, as the runtime knows it.
std::optional<rt::SpecialShader> special_shader(const sl_object& general,
                                                std::span<const rt::BoundValue> constants,
                                                const slc::ObjectOptions& options) {
    std::vector<slc::ConstantParam> params;
    params.reserve(constants.size());
    for (const rt::BoundValue& value : constants) {
        params.push_back(
            {value.name, value.floats, value.strings.empty() ? "" : value.strings.front()});
    }
    std::string error; // the general shader runs on
    auto made = slc::special_order(general, params, options, error);
    if (!made) {
        return std::nullopt;
    }
    const auto order = std::make_shared<const slc::SpecialOrder>(std::move(*made));
    rt::SpecialShader shader;
    shader.key = order->key;
    shader.gain = order->gain;
    shader.compile_seconds = compile_seconds(order->special.num_statements);
    shader.compile = [order, options](base::Diag& diag, const rt::Cancelled& cancelled) {
        slc::ObjectOptions stoppable = options;
        stoppable.front.cancelled = cancelled;
        slc::BuiltObject built = slc::build_special(*order, stoppable, diag);
        return built.outcome == slc::Outcome::Done ? std::optional(std::move(built.bytes))
                                                   : std::nullopt;
    };
    return shader;
}

std::uint64_t cache_bytes(base::Diag& diag) {
    const char* text = std::getenv("PERIGEE_CACHE_SIZE");
    const auto size = text != nullptr ? rt::parse_cache_size(text) : rt::default_cache_bytes;
    if (!size) {
        diag.report(base::Severity::Warning, base::Code::Range, {},
                    std::string("PERIGEE_CACHE_SIZE: '") + text +
                        "' is no size like 200M or 2G; 512M is used");
    }
    return size.value_or(rt::default_cache_bytes);
}

// What the user named: switches, environment, the current directory, the installation.
std::vector<std::string> trusted_directories(const trace::RenderOptions& options) {
    std::vector<std::string> directories = options.shader_path;
    const std::vector<std::string> more = default_shader_path();
    directories.insert(directories.end(), more.begin(), more.end());
    return directories;
}

// --display-server, else PERIGEE_DISPLAY, else what there is.
trace::LiveServers live_servers(const trace::RenderOptions& options, base::Diag& diag) {
    if (options.servers) {
        return *options.servers;
    }
    const char* value = std::getenv("PERIGEE_DISPLAY");
    const std::string text = value != nullptr && *value != '\0' ? value : "auto";
    const auto servers = trace::parse_live_servers(text);
    if (!servers) {
        diag.report(base::Severity::Warning, base::Code::BadToken, {},
                    "PERIGEE_DISPLAY is '" + text + "', not " +
                        std::string(trace::live_servers_form) + "; auto is used");
    }
    return servers ? *servers : *trace::parse_live_servers("auto");
}

trace::LiveSettings live_settings(const trace::RenderOptions& options, base::Diag& diag) {
    trace::LiveSettings settings;
    settings.on_terminal = isatty(STDERR_FILENO) != 0;
    settings.every_frame = options.show;
    // A framebuffer in a RIB opens nothing where nobody could read the address (live-006).
    settings.framebuffers =
        options.show || settings.on_terminal || std::getenv("PERIGEE_DISPLAY") != nullptr;
    settings.every = options.show_every;
    settings.servers = live_servers(options, diag);
    return settings;
}

trace::RendererConfig renderer_config(const trace::RenderOptions& options,
                                      base::ShadeopLibrary& shadeops, base::Diag& diag) {
    trace::RendererConfig config;
    config.settings.num_threads = options.num_threads;
    config.settings.progress = options.progress;
    config.settings.interrupted = base::is_interrupted;
    config.settings.specialise = options.specialise;
    config.settings.is_verbose = options.verbose;
    config.settings.keep_existing = options.safe;
    config.settings.trace_pixels = options.trace_pixels;
    config.settings.check_energy = options.check_energy;
    config.settings.checkpoint = options.checkpoint;
    config.keep_previews = !options.report.empty();
    config.is_verbose = options.verbose;
    config.profile_shaders = !options.profile_shaders.empty();
    config.shaders.search_path = installed_shaders();
    config.shaders.trusted = trusted_directories(options);
    config.shaders.trust_all = options.allow_programs;
    config.shaders.cache_bytes = cache_bytes(diag);
    config.shaders.cache_dir = config.shaders.cache_bytes > 0 ? rt::default_cache_dir() : "";
    config.shaders.num_threads = base::thread_count(options.num_threads);
    config.shaders.interrupted = base::is_interrupted;
    config.settings.shadeops = &shadeops;
    config.shaders.compile = [&shadeops](const std::string& sl_path, base::Diag& said,
                                         const rt::Cancelled& cancelled) {
        return slc::compile_to_bytes(sl_path, compile_options({}, cancelled, shadeops), said);
    };
    config.shaders.cache_key = [&shadeops, index_dir = config.shaders.cache_dir](
                                   const std::string& sl_path, base::Diag& said,
                                   const rt::Cancelled& cancelled) {
        return slc::object_key(sl_path, compile_options(index_dir, cancelled, shadeops), said);
    };
    config.shaders.specialise =
        [&shadeops, profile = config.profile_shaders](const sl_object& general,
                                                      std::span<const rt::BoundValue> constants) {
            slc::ObjectOptions object = compile_options({}, {}, shadeops);
            object.profile = profile;
            return special_shader(general, constants, object);
        };
    config.shaders.checked = [&shadeops](const sl_object& general) {
        slc::ObjectOptions object = compile_options({}, {}, shadeops);
        object.checked = true;
        return special_shader(general, {}, object);
    };
    config.shaders.path_first = options.shader_path;
    return config;
}

// The picture of a RIB that names none: its own name with .tif; that of standard input is ri.tif.
std::string default_output(const std::string& file) {
    return file == "-" ? "ri.tif" : fs::path(file).filename().replace_extension(".tif").string();
}

// --- the run

// RIB that comes before the files (bmrt.md): the user's ~/.rendribrc, else the site's
// $BMRTHOME/.rendribrc; then -option.
std::string preferences_file() {
    for (const char* variable : {"HOME", "BMRTHOME"}) {
        const char* directory = std::getenv(variable);
        std::string path = directory != nullptr ? std::string(directory) + "/.rendribrc" : "";
        if (directory != nullptr && access(path.c_str(), F_OK) == 0) {
            return path;
        }
    }
    return "";
}

rib::ReadStatus read_preludes(rib::Reader& reader, const trace::RenderOptions& options) {
    const std::string preferences = preferences_file();
    rib::ReadStatus worst =
        preferences.empty() ? rib::ReadStatus::Ok : reader.read_file(preferences);
    for (const std::string& text : options.rib_texts) {
        worst = std::max(worst, reader.read_text(text, "-option"));
    }
    return worst;
}

// One rendering context for all files, as if they were one; but a file that fails does not stop the
// next.
rib::ReadStatus read_all(rib::Reader& reader, trace::Renderer& renderer,
                         const trace::RenderOptions& options, base::Diag& diag) {
    rib::ReadStatus worst = read_preludes(reader, options);
    for (const std::string& file : options.files) {
        if (base::is_interrupted()) {
            break;
        }
        if (options.verbose) {
            diag.report(base::Severity::Info, base::Code::None, {}, "reading " + file);
        }
        renderer.set_file(file, default_output(file));
        worst = std::max(worst, file == "-" ? reader.read_stdin() : reader.read_file(file));
    }
    return worst;
}

void report_later_switches(const trace::RenderOptions& options, base::Diag& diag) {
    for (const std::string& name : options.not_yet) {
        diag.report_once(name, base::Severity::Info, base::Code::Unimplement, {},
                         "switch " + name + " has no effect yet");
    }
}

// False after a message if the file could not be written.
bool write_report(const char* name, const std::string& path, const std::string& text,
                  base::Diag& diag) {
    const std::string error = base::write_file_atomically(path, text);
    if (!error.empty()) {
        diag.report(base::Severity::Error, base::Code::System, {},
                    std::string(name) + ": " + error);
    }
    return error.empty();
}

bool report_run(const trace::RenderOptions& options, const trace::RunRecord& run,
                base::Diag& diag) {
    if (options.stats) {
        std::fputs(trace::run_text(run).c_str(), stderr);
    }
    bool ok = options.stats_json.empty() ||
              write_report("--stats-json", options.stats_json, trace::run_json(run), diag);
    ok &= options.report.empty() ||
          write_report("--report", options.report, trace::run_html(run), diag);
    return ok;
}

// --profile-shaders. False after a message if the file could not be written.
bool write_profile(const std::string& path, const trace::ShaderListing& listing, base::Diag& diag) {
    if (path == "-") {
        std::fputs(trace::listing_text(listing).c_str(), stdout);
        return true;
    }
    const std::string text =
        path.ends_with(".json") ? trace::listing_json(listing) : trace::listing_text(listing);
    return write_report("--profile-shaders", path, text, diag);
}

// Errors whose code names the machine and not the input: no compiler, no memory, a full disk.
bool environment_failed(const base::Diag& diag) {
    const std::vector<base::MessageRecord> records = diag.records();
    return std::ranges::any_of(records, [](const base::MessageRecord& record) {
        return record.severity >= base::Severity::Error &&
               (record.code == base::Code::System || record.code == base::Code::NoMem ||
                record.code == base::Code::DiskFull);
    });
}

int exit_code(rib::ReadStatus status, const trace::Renderer& renderer,
              const trace::RenderOptions& options, const base::Diag& diag) {
    if (status == rib::ReadStatus::Environment || renderer.result() == trace::FrameResult::Failed ||
        environment_failed(diag)) {
        return exit_environment;
    }
    const bool strict_failure = options.strict && diag.count(base::Severity::Warning) > 0;
    return diag.had_errors() || strict_failure ? exit_input : exit_done;
}

int merge(const trace::RenderOptions& options) {
    base::Diag diag;
    if (options.silent) {
        diag.set_threshold(base::Severity::Error);
    }
    switch (trace::merge_tiles(options.output, options.files, options.crop, diag)) {
    case trace::MergeResult::Written:
        return exit_done;
    case trace::MergeResult::BadTiles:
        return exit_input;
    case trace::MergeResult::Failed:
        break;
    }
    return exit_environment;
}

int run(const trace::RenderOptions& options, const std::vector<const char*>& arguments) {
    base::Diag diag;
    if (options.silent) {
        diag.set_threshold(base::Severity::Error);
    }
    report_later_switches(options, diag);
    trace::LiveDisplay live(live_settings(options, diag), diag);
    if (options.show) {
        live.start(); // early: the address can be opened while the scene is read
    }
    base::ShadeopLibrary shadeops(options.shadeop_path);
    slc::report_shadeops(shadeops, diag);
    trace::RendererConfig config = renderer_config(options, shadeops, diag);
    config.settings.live = &live;
    trace::Renderer renderer(std::move(config), diag);
    rib::Reader reader(renderer, diag, reader_config(options, diag));
    const rib::ReadStatus status = read_all(reader, renderer, options, diag);
    const bool stopped = base::is_interrupted();
    renderer.stop();
    trace::RunRecord& record = renderer.finish();
    record.arguments.assign(arguments.begin(), arguments.end());
    bool reported = report_run(options, record, diag);
    if (!options.profile_shaders.empty()) {
        reported = write_profile(options.profile_shaders, renderer.listing(), diag) && reported;
    }
    live.finish(base::is_interrupted); // pages are told; Ctrl-C now ends the showing only
    if (stopped) {
        base::finish_interrupt();
    }
    return reported ? exit_code(status, renderer, options, diag) : exit_environment;
}

// What one switch cannot tell: nothing to read means standard input, unless a user sits there.
void complete(trace::ParsedOptions& parsed) {
    trace::RenderOptions& options = parsed.options;
    if (!parsed.error.empty()) {
        return;
    }
    if (options.merge && (options.output.empty() || options.files.empty())) {
        parsed.error = "--merge needs -o FILE and the tiles";
    } else if (options.files.empty()) {
        if (isatty(STDIN_FILENO) != 0) {
            parsed.error = "no RIB file";
        }
        options.files.emplace_back("-");
    }
}

} // namespace

int main(int argc, char** argv) {
    base::open_standard_streams();
    base::catch_interrupts();
    const std::string program = argc > 0 ? fs::path(argv[0]).filename().string() : "render";
    const std::vector<const char*> arguments(argv + (argc > 0 ? 1 : 0), argv + argc);
    trace::ParsedOptions parsed = trace::parse_options(arguments);
    complete(parsed);
    if (parsed.options.help) {
        std::fputs(trace::usage_text(program).c_str(), stdout);
        return exit_done;
    }
    if (parsed.options.version) {
        std::printf("%s %s\n", trace::renderer_name, trace::renderer_version_text);
        return exit_done;
    }
    if (!parsed.error.empty()) {
        std::fprintf(stderr, "%s: error: %s\n%s", program.c_str(), parsed.error.c_str(),
                     trace::usage_text(program).c_str());
        return exit_usage;
    }
    return parsed.options.merge ? merge(parsed.options) : run(parsed.options, arguments);
}
