// SPDX-License-Identifier: Apache-2.0
#include "slc/toolchain.h"

#include "runtime/base/file.h"
#include "runtime/base/module.h"
#include "runtime/base/seal.h"
#include "runtime/base/temp_dir.h"
#include "sl_fingerprint.h"
#include "slc/process.h"
#include "slc_build_id.h"

#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>

namespace slc {

namespace {

namespace fs = std::filesystem;

bool is_file(const std::string& path) {
    struct stat info {};
    return ::stat(path.c_str(), &info) == 0 && S_ISREG(info.st_mode);
}

std::string on_path(const std::string& program) {
    if (program.find('/') != std::string::npos) {
        return ::access(program.c_str(), X_OK) == 0 ? program : "";
    }
    const char* variable = std::getenv("PATH");
    std::string_view path = variable ? variable : "/usr/bin:/bin";
    while (!path.empty()) {
        const std::size_t end = path.find(':');
        const std::string candidate = std::string(path.substr(0, end)) + "/" + program;
        if (is_file(candidate) && ::access(candidate.c_str(), X_OK) == 0) {
            return candidate;
        }
        path = end == std::string_view::npos ? std::string_view() : path.substr(end + 1);
    }
    return "";
}

bool place_files(Toolchain& tools) {
    const fs::path bin = base::program_directory();
    const fs::path installed = bin.parent_path();
    if (is_file((installed / "include/perigee/sl_shader.h").string()) &&
        is_file((installed / "lib/perigee/libsl_lanes4.a").string())) {
        tools.include_dir = (installed / "include/perigee").string();
        tools.archive_dir = (installed / "lib/perigee").string();
        return true;
    }
    // The build tree: programs and tests lie one folder below its top.
    const fs::path built = installed / "runtime/lib";
    if (is_file((built / "libsl_lanes4.a").string())) {
        tools.include_dir =
            std::string(SLC_SOURCE_ROOT) + "/runtime/lib:" + SLC_SOURCE_ROOT + "/runtime/abi";
        tools.archive_dir = built.string();
        return true;
    }
    return false;
}

bool is_folder(const std::string& path) {
    struct stat info {};
    return ::stat(path.c_str(), &info) == 0 && S_ISDIR(info.st_mode);
}

std::vector<std::string> split(std::string_view text, char separator) {
    std::vector<std::string> parts;
    while (!text.empty()) {
        const std::size_t end = text.find(separator);
        parts.emplace_back(text.substr(0, end));
        text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
    }
    return parts;
}

std::string archive(const Toolchain& tools, int lanes) {
    return tools.archive_dir + "/libsl_lanes" + std::to_string(lanes) + ".a";
}

std::vector<std::string> code_flags(const CompileFlags& flags) {
    std::vector<std::string> all = {
        "-std=gnu11",
        "-O" + std::to_string(flags.optimisation),
        "-fPIC",
        "-fvisibility=hidden",
        "-ffp-contract=off", // the same bits whatever the instruction set
        "-fno-math-errno",
        "-fno-trapping-math",
        "-fno-ident",
        "-fno-asynchronous-unwind-tables",
        "-w",
    };
#if defined(__SANITIZE_ADDRESS__)
    all.insert(all.end(), {"-fsanitize=address,undefined", "-fno-omit-frame-pointer"});
#endif
    all.insert(all.end(), flags.extra.begin(), flags.extra.end());
    return all;
}

// What all steps of one object share.
struct Workshop {
    const Toolchain& tools;
    const CompileFlags& flags;
    ProcessSettings settings;
};

// "" if all went well.
std::string run(const Workshop& shop, const std::vector<std::string>& argv,
                std::string_view input) {
    const ProcessResult result = run_process(argv, input, shop.settings);
    std::string messages;
    if (result.cancelled) {
        messages = "cancelled";
    } else if (!result.started) {
        messages = argv[0] + " cannot be run";
    } else if (result.cut_off) {
        messages = argv[0] + " was stopped at a resource limit";
    } else if (result.exit_code != 0) {
        messages = result.err.empty() ? argv[0] + " failed" : result.err;
    }
    return messages;
}

std::string compile_variant(const Workshop& shop, const VariantText& variant,
                            const std::string& object) {
    std::vector<std::string> argv = {shop.tools.compiler};
    for (std::string& flag : code_flags(shop.flags)) {
        argv.push_back(std::move(flag));
    }
    if (variant.lanes == 8) {
        argv.emplace_back("-mavx2");
        // Copies structures of lanes by 32 bytes: what was stored in halves cannot be forwarded to
        // whole loads, which cost 70 % more time in calls of noise (docs/design/runtime-lib.md).
        argv.emplace_back("-mtune=skylake-avx512");
    }
    for (const std::string& dir : split(shop.tools.include_dir, ':')) {
        argv.push_back("-I" + dir);
    }
    argv.insert(argv.end(), {"-c", "-x", "c", "-", "-o", object});
    return run(shop, argv, variant.c);
}

std::string link(const Workshop& shop, const std::vector<VariantText>& variants,
                 const std::vector<std::string>& objects, const std::string& output) {
    // No start files and no libraries: an object defines all it needs but memcpy and its like,
    // which the program has.
    std::vector<std::string> argv = {
        shop.tools.compiler, "-shared",           "-nostdlib", "-Wl,--build-id=none",
        "-Wl,--gc-sections", "-Wl,--strip-debug", "-o",        output};
    argv.insert(argv.end(), objects.begin(), objects.end());
    for (const VariantText& variant : variants) {
        argv.push_back(archive(shop.tools, variant.lanes));
    }
    return run(shop, argv, {});
}

// Compiles the variants side by side and links them; "" or what went wrong.
std::string build_in(const base::TempDir& dir, const Workshop& shop,
                     const std::vector<VariantText>& variants, const std::string& linked) {
    std::vector<std::string> objects;
    std::vector<std::string> errors(variants.size());
    for (const VariantText& variant : variants) {
        objects.push_back(dir.path() + "/lanes" + std::to_string(variant.lanes) + ".o");
    }
    {
        std::vector<std::jthread> others;
        for (std::size_t i = 1; i < variants.size(); ++i) {
            others.emplace_back(
                [&, i] { errors[i] = compile_variant(shop, variants[i], objects[i]); });
        }
        errors[0] = compile_variant(shop, variants[0], objects[0]);
    }
    for (const std::string& error : errors) {
        if (!error.empty()) {
            return error;
        }
    }
    return link(shop, variants, objects, linked);
}

std::string file_identity(const std::string& path) {
    struct stat info {};
    if (::stat(path.c_str(), &info) != 0) {
        return path + "?";
    }
    return path + " " + std::to_string(info.st_size) + " " + std::to_string(info.st_mtim.tv_sec) +
           "." + std::to_string(info.st_mtim.tv_nsec);
}

} // namespace

int native_lanes() {
    return __builtin_cpu_supports("avx2") != 0 ? 8 : 4;
}

std::string standard_headers() {
    const fs::path top = fs::path(base::program_directory()).parent_path();
    const std::string installed = (top / "share/perigee/headers").string();
    const std::string source = std::string(SLC_SOURCE_ROOT) + "/shaders/headers";
    const bool is_built = is_file((top / "runtime/lib/libsl_lanes4.a").string());
    return is_folder(installed) ? installed : is_built && is_folder(source) ? source : "";
}

std::optional<Toolchain> find_toolchain(const std::string& compiler, base::Diag& diag) {
    Toolchain tools;
    const std::vector<std::string> names = compiler.empty()
                                               ? std::vector<std::string>{"cc", "gcc", "clang"}
                                               : std::vector<std::string>{compiler};
    for (const std::string& name : names) {
        tools.compiler = on_path(name);
        if (!tools.compiler.empty()) {
            break;
        }
    }
    if (tools.compiler.empty()) {
        diag.report_once("no compiler", base::Severity::Error, base::Code::System, {},
                         "shaders cannot be compiled: no C compiler (" +
                             (compiler.empty() ? "cc, gcc or clang" : compiler) +
                             ") was found; install one, for instance with apt-get install gcc");
        return std::nullopt;
    }
    if (!place_files(tools)) {
        diag.report_once(
            "no shader header", base::Severity::Error, base::Code::System, {},
            "shaders cannot be compiled: sl_shader.h and libsl_lanes4.a are neither in "
            "include/perigee and lib/perigee beside " +
                base::program_directory() + " nor in a build tree");
        return std::nullopt;
    }
    return tools;
}

std::string toolchain_identity(const Toolchain& tools, const CompileFlags& flags) {
    std::error_code error;
    const fs::path real = fs::canonical(tools.compiler, error);
    std::string text = file_identity(error ? tools.compiler : real.string());
    text += "\n" SLC_BUILD_ID;
    for (const std::string& flag : code_flags(flags)) {
        text += "\n" + flag;
    }
    return text;
}

std::optional<std::string> build_shared_object(const Toolchain& tools,
                                               const std::vector<VariantText>& variants,
                                               const CompileFlags& flags, const std::string& name,
                                               const std::function<bool()>& cancelled,
                                               base::Diag& diag) {
    const base::TempDir dir("slc");
    if (dir.path().empty()) {
        diag.report(base::Severity::Error, base::Code::System, {},
                    "no temporary directory can be made");
        return std::nullopt;
    }
    ProcessSettings settings;
    settings.temp_dir = dir.path(); // what the compiler leaves when it is ended goes with it
    settings.cancelled = cancelled;
    const std::string linked = dir.path() + "/shader.so";
    const std::string message = build_in(dir, {tools, flags, settings}, variants, linked);
    if (cancelled && cancelled()) {
        return std::nullopt;
    }
    if (!message.empty()) {
        diag.report(base::Severity::Error, base::Code::Bug, {},
                    name + ": the C compiler refused the generated code: " + message);
        return std::nullopt;
    }
    auto bytes = base::read_file(linked);
    if (!bytes) {
        diag.report(base::Severity::Error, base::Code::System, {}, "cannot read " + linked);
        return std::nullopt;
    }
    *bytes += base::seal(*bytes, SL_ABI_FINGERPRINT);
    return bytes;
}

} // namespace slc
