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
#include "tracer/options.h"
#include "tracer/renderer.h"
#include "tracer/version.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
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
    return path;
}

// --- configuration

rib::Options rib_defaults(const trace::RenderOptions& options) {
    rib::Options defaults;
    if (options.res) {
        std::tie(defaults.xres, defaults.yres) = *options.res;
    }
    if (options.samples) {
        std::tie(defaults.xsamples, defaults.ysamples) = *options.samples;
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
slc::ObjectOptions compile_options(const std::string& index_dir, const rt::Cancelled& cancelled) {
    slc::ObjectOptions options;
    options.native_only = true;
    options.index_dir = index_dir;
    options.front.cancelled = cancelled;
    return options;
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

trace::RendererConfig renderer_config(const trace::RenderOptions& options, base::Diag& diag) {
    trace::RendererConfig config;
    config.settings.num_threads = options.num_threads;
    config.settings.progress = options.progress;
    config.settings.interrupted = base::is_interrupted;
    config.settings.keep_existing = options.safe;
    config.settings.trace_pixels = options.trace_pixels;
    config.settings.checkpoint = options.checkpoint;
    config.keep_previews = !options.report.empty();
    config.is_verbose = options.verbose;
    config.shaders.search_path = installed_shaders();
    config.shaders.trusted = trusted_directories(options);
    config.shaders.trust_all = options.allow_programs;
    config.shaders.cache_bytes = cache_bytes(diag);
    config.shaders.cache_dir = config.shaders.cache_bytes > 0 ? rt::default_cache_dir() : "";
    config.shaders.num_threads = base::thread_count(options.num_threads);
    config.shaders.interrupted = base::is_interrupted;
    config.shaders.compile = [](const std::string& sl_path, base::Diag& said,
                                const rt::Cancelled& cancelled) {
        return slc::compile_to_bytes(sl_path, compile_options({}, cancelled), said);
    };
    config.shaders.cache_key =
        [index_dir = config.shaders.cache_dir](const std::string& sl_path, base::Diag& said,
                                               const rt::Cancelled& cancelled) {
            return slc::object_key(sl_path, compile_options(index_dir, cancelled), said);
        };
    config.shaders.path_first = options.shader_path;
    return config;
}

// The picture of a RIB that names none: its own name with .tif; that of standard input is ri.tif.
std::string default_output(const std::string& file) {
    return file == "-" ? "ri.tif" : fs::path(file).filename().replace_extension(".tif").string();
}

// --- the run

// RIB that comes before the files: ~/.rendribrc, then -option.
rib::ReadStatus read_preludes(rib::Reader& reader, const trace::RenderOptions& options) {
    if (const char* home = std::getenv("HOME")) {
        const std::string path = std::string(home) + "/.rendribrc";
        if (access(path.c_str(), R_OK) == 0) {
            const rib::ReadStatus status = reader.read_file(path);
            if (status != rib::ReadStatus::Ok) {
                return status;
            }
        }
    }
    for (const std::string& text : options.rib_texts) {
        const rib::ReadStatus status = reader.read_text(text, "-option");
        if (status != rib::ReadStatus::Ok) {
            return status;
        }
    }
    return rib::ReadStatus::Ok;
}

rib::ReadStatus read_all(rib::Reader& reader, trace::Renderer& renderer,
                         const trace::RenderOptions& options, base::Diag& diag) {
    rib::ReadStatus worst = read_preludes(reader, options);
    for (const std::string& file : options.files) {
        if (worst == rib::ReadStatus::Stopped || base::is_interrupted()) {
            break;
        }
        if (options.verbose) {
            diag.report(base::Severity::Info, base::Code::None, {}, "reading " + file);
        }
        renderer.set_file(file, default_output(file));
        const rib::ReadStatus status = file == "-" ? reader.read_stdin() : reader.read_file(file);
        worst = status == rib::ReadStatus::Ok ? worst : status;
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

int exit_code(rib::ReadStatus status, const trace::Renderer& renderer,
              const trace::RenderOptions& options, const base::Diag& diag) {
    if (status == rib::ReadStatus::Environment || renderer.result() == trace::FrameResult::Failed) {
        return exit_environment;
    }
    const bool strict_failure = options.strict && diag.count(base::Severity::Warning) > 0;
    return diag.had_errors() || strict_failure ? exit_input : exit_done;
}

int run(const trace::RenderOptions& options, const std::vector<const char*>& arguments) {
    base::Diag diag;
    if (options.silent) {
        diag.set_threshold(base::Severity::Error);
    }
    report_later_switches(options, diag);
    base::catch_interrupts();
    trace::LiveDisplay live(live_settings(options, diag), diag);
    if (options.show) {
        live.start(); // early: the address can be opened while the scene is read
    }
    trace::RendererConfig config = renderer_config(options, diag);
    config.settings.live = &live;
    trace::Renderer renderer(std::move(config), diag);
    rib::Reader reader(renderer, diag, reader_config(options, diag));
    const rib::ReadStatus status = read_all(reader, renderer, options, diag);
    if (base::is_interrupted()) {
        live.finish(base::is_interrupted); // pages are told
    }
    renderer.stop();
    base::finish_interrupt();
    trace::RunRecord& record = renderer.finish();
    record.arguments.assign(arguments.begin(), arguments.end());
    const bool reported = report_run(options, record, diag);
    live.finish(base::is_interrupted); // Ctrl-C ends the showing only: the work is done
    return reported ? exit_code(status, renderer, options, diag) : exit_environment;
}

} // namespace

int main(int argc, char** argv) {
    const std::string program = argc > 0 ? fs::path(argv[0]).filename().string() : "render";
    const std::vector<const char*> arguments(argv + (argc > 0 ? 1 : 0), argv + argc);
    trace::ParsedOptions parsed = trace::parse_options(arguments);
    if (parsed.error.empty() && parsed.options.files.empty()) {
        if (isatty(STDIN_FILENO) != 0) {
            parsed.error = "no RIB file";
        }
        parsed.options.files.emplace_back("-");
    }
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
    return run(parsed.options, arguments);
}
