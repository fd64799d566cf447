// SPDX-License-Identifier: Apache-2.0
#include "slc/toolchain.h"

#include "runtime/base/file.h"
#include "runtime/base/seal.h"
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

// Where the running program lies, links resolved.
fs::path program_dir() {
    std::error_code error;
    const fs::path self = fs::read_symlink("/proc/self/exe", error);
    return error ? fs::path() : self.parent_path();
}

bool place_files(Toolchain& tools) {
    const fs::path bin = program_dir();
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

// A directory of its own for intermediate files, removed at the end.
class WorkDir {
public:
    WorkDir() {
        std::error_code error;
        std::string pattern = (fs::temp_directory_path(error) / "slc-XXXXXX").string();
        if (!error && ::mkdtemp(pattern.data())) {
            path_ = pattern;
        }
    }
    ~WorkDir() {
        std::error_code ignored;
        if (!path_.empty()) {
            fs::remove_all(path_, ignored);
        }
    }
    WorkDir(const WorkDir&) = delete;
    WorkDir& operator=(const WorkDir&) = delete;
    [[nodiscard]] const std::string& path() const { return path_; }

private:
    std::string path_;
};

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

bool run(const std::vector<std::string>& argv, std::string_view input, std::string& messages) {
    const ProcessResult result = run_process(argv, input);
    if (!result.started) {
        messages = argv[0] + " cannot be run";
    } else if (result.cut_off) {
        messages = argv[0] + " was stopped at a resource limit";
    } else if (result.exit_code != 0) {
        messages = result.err.empty() ? argv[0] + " failed" : result.err;
    }
    return messages.empty();
}

std::string compile_variant(const Toolchain& tools, const VariantText& variant,
                            const CompileFlags& flags, const std::string& object) {
    std::vector<std::string> argv = {tools.compiler};
    for (std::string& flag : code_flags(flags)) {
        argv.push_back(std::move(flag));
    }
    if (variant.lanes == 8) {
        argv.emplace_back("-mavx2");
        // Copies structures of lanes by 32 bytes: what was stored in halves cannot be forwarded to
        // whole loads, which cost 70 % more time in calls of noise (docs/design/runtime-lib.md).
        argv.emplace_back("-mtune=skylake-avx512");
    }
    for (const std::string& dir : split(tools.include_dir, ':')) {
        argv.push_back("-I" + dir);
    }
    argv.insert(argv.end(), {"-c", "-x", "c", "-", "-o", object});
    std::string messages;
    run(argv, variant.c, messages);
    return messages;
}

std::string link(const Toolchain& tools, const std::vector<VariantText>& variants,
                 const std::vector<std::string>& objects, const std::string& output) {
    // No start files and no libraries: an object defines all it needs but memcpy and its like,
    // which the program has.
    std::vector<std::string> argv = {
        tools.compiler,      "-shared",           "-nostdlib", "-Wl,--build-id=none",
        "-Wl,--gc-sections", "-Wl,--strip-debug", "-o",        output};
    argv.insert(argv.end(), objects.begin(), objects.end());
    for (const VariantText& variant : variants) {
        argv.push_back(archive(tools, variant.lanes));
    }
    std::string messages;
    run(argv, {}, messages);
    return messages;
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
                program_dir().string() + " nor in a build tree");
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

bool build_shared_object(const Toolchain& tools, const std::vector<VariantText>& variants,
                         const CompileFlags& flags, const std::string& slo_path, base::Diag& diag) {
    // An object from before must not pass for the result of this compilation.
    ::unlink(slo_path.c_str());
    const WorkDir work;
    if (work.path().empty()) {
        diag.report(base::Severity::Error, base::Code::System, {},
                    "no temporary directory can be made");
        return false;
    }
    std::vector<std::string> objects;
    std::vector<std::string> errors(variants.size());
    for (const VariantText& variant : variants) {
        objects.push_back(work.path() + "/lanes" + std::to_string(variant.lanes) + ".o");
    }
    {
        std::vector<std::jthread> others;
        for (std::size_t i = 1; i < variants.size(); ++i) {
            others.emplace_back(
                [&, i] { errors[i] = compile_variant(tools, variants[i], flags, objects[i]); });
        }
        errors[0] = compile_variant(tools, variants[0], flags, objects[0]);
    }
    const std::string linked = work.path() + "/shader.so";
    std::string message;
    for (const std::string& e : errors) {
        message = message.empty() ? e : message;
    }
    if (message.empty()) {
        message = link(tools, variants, objects, linked);
    }
    if (!message.empty()) {
        diag.report(base::Severity::Error, base::Code::Bug, {},
                    slo_path + ": the C compiler refused the generated code: " + message);
        return false;
    }
    auto bytes = base::read_file(linked);
    if (!bytes) {
        diag.report(base::Severity::Error, base::Code::System, {}, "cannot read " + linked);
        return false;
    }
    *bytes += base::seal(*bytes, SL_ABI_FINGERPRINT);
    message = base::write_file_atomically(slo_path, *bytes);
    if (!message.empty()) {
        diag.report(base::Severity::Error, base::Code::NoFile, {}, message);
        return false;
    }
    return true;
}

} // namespace slc
