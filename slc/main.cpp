// SPDX-License-Identifier: Apache-2.0
// The program slc: compiles SL files into shader objects; --help lists the options. Files are
// compiled by several threads; what each has to say is printed in the order of the command line.
#include "runtime/base/sha256.h"
#include "slc/driver.h"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <set>
#include <string_view>
#include <thread>
#include <unistd.h>

namespace {

using slc::Outcome;

constexpr std::string_view usage = R"(usage: slc [options] file.sl...
Compiles RenderMan Shading Language shaders. Each shader becomes <name of the shader>.slo.

  -o FILE              write the object to FILE (one shader only)
  -d DIR               write objects into DIR (default: the current directory)
  -I DIR               look for included files in DIR; may be repeated
  -D NAME[=VALUE]      define a preprocessor macro; may be repeated
  -O LEVEL             optimisation of the C compiler, 0 to 3 (default 2)
  -j N                 compile N files at a time (default: the number of processors)
  -q                   say nothing but errors and warnings
  --check              check only, write nothing
  --explain            print why each shader variable is needed
  --dump=WHAT          print tokens, ast, ir, facts or c instead of compiling
  --native             only code for this processor (default: AVX2 and plain x86-64)
  --cc=PROGRAM         C compiler and preprocessor (default: cc, gcc or clang)
  --target=c           what to make; opencl and both are not part of this version
  --help, --version

Exit status: 0 done, 1 errors in the input, 2 wrong usage, 3 the environment failed.
)";

struct Options {
    slc::ObjectOptions object;
    std::string output;
    std::string dir = ".";
    std::string dump;
    bool quiet = false;
    bool check = false;
    bool explain = false;
    unsigned jobs = std::max(1U, std::thread::hardware_concurrency());
    std::vector<std::string> files;
};

int wrong_usage(const std::string& text) {
    std::fprintf(stderr, "slc: %s; see slc --help\n", text.c_str());
    return 2;
}

// The value of an option written -Xvalue or -X value.
std::optional<std::string> short_value(int argc, char** argv, int& i) {
    const std::string_view arg = argv[i];
    if (arg.size() > 2) {
        return std::string(arg.substr(2));
    }
    if (i + 1 >= argc) {
        return std::nullopt;
    }
    return std::string(argv[++i]);
}

bool parse_number(const std::string& text, unsigned lowest, unsigned highest, unsigned& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() && value >= lowest &&
           value <= highest;
}

// -1: go on; otherwise the exit status.
int take_long_option(std::string_view arg, Options& options) {
    const std::size_t equals = arg.find('=');
    const std::string_view name = arg.substr(0, equals);
    const std::string value(equals == std::string_view::npos ? "" : arg.substr(equals + 1));
    if (arg == "--help") {
        std::fwrite(usage.data(), 1, usage.size(), stdout);
        return 0;
    }
    if (arg == "--version") {
        std::printf("slc (Perigee) %s\n", PERIGEE_VERSION);
        return 0;
    }
    if (arg == "--check") {
        options.check = true;
    } else if (arg == "--explain") {
        options.explain = true;
    } else if (arg == "--native") {
        options.object.native_only = true;
    } else if (name == "--cc" && !value.empty()) {
        options.object.front.preprocessor = value;
    } else if (name == "--dump") {
        if (value != "c" && !slc::dump_kind(value)) {
            return wrong_usage("--dump wants tokens, ast, ir, facts or c, not \"" + value + "\"");
        }
        options.dump = value;
    } else if (name == "--target") {
        if (value == "opencl" || value == "both") {
            return wrong_usage("--target=" + value + ": OpenCL is not part of this version");
        }
        if (value != "c") {
            return wrong_usage("--target wants c, not \"" + value + "\"");
        }
    } else {
        return wrong_usage("unknown option " + std::string(arg));
    }
    return -1;
}

int take_short_option(int argc, char** argv, int& i, Options& options) {
    const std::string arg = argv[i];
    if (arg == "-q") {
        options.quiet = true;
        return -1;
    }
    const char letter = arg[1];
    if (std::string_view("odIDOj").find(letter) == std::string_view::npos) {
        return wrong_usage("unknown option " + arg);
    }
    const auto value = short_value(argc, argv, i);
    if (!value) {
        return wrong_usage(arg + " wants a value");
    }
    unsigned number = 0;
    switch (letter) {
    case 'o':
        options.output = *value;
        break;
    case 'd':
        options.dir = *value;
        break;
    case 'I':
        options.object.front.include_dirs.push_back(*value);
        break;
    case 'D':
        options.object.front.defines.push_back(*value);
        break;
    case 'O':
        if (!parse_number(*value, 0, 3, number)) {
            return wrong_usage("-O wants 0 to 3");
        }
        options.object.flags.optimisation = static_cast<int>(number);
        break;
    default:
        if (!parse_number(*value, 1, 1024, options.jobs)) {
            return wrong_usage("-j wants a number from 1 to 1024");
        }
    }
    return -1;
}

int parse_arguments(int argc, char** argv, Options& options) {
    bool only_files = false;
    for (int i = 1; i < argc; ++i) {
        const std::string_view arg = argv[i];
        int status = -1;
        if (only_files || arg.size() < 2 || arg[0] != '-') {
            options.files.emplace_back(arg);
        } else if (arg == "--") {
            only_files = true;
        } else if (arg.starts_with("--")) {
            status = take_long_option(arg, options);
        } else {
            status = take_short_option(argc, argv, i, options);
        }
        if (status >= 0) {
            return status;
        }
    }
    if (options.files.empty()) {
        return wrong_usage("no input file");
    }
    if (!options.output.empty() && options.files.size() > 1) {
        return wrong_usage("-o names one object, but there are " +
                           std::to_string(options.files.size()) + " input files");
    }
    return -1;
}

// What one file had to say and what became of it.
struct FileResult {
    Outcome outcome = Outcome::Done;
    std::string out;
    std::string err;
    bool finished = false;
};

Outcome dump(const std::string& file, const Options& options, base::Diag& diag, std::string& out) {
    if (options.dump != "c") {
        const auto text =
            slc::dump_file(file, *slc::dump_kind(options.dump), options.object.front, diag);
        out += text.value_or("");
        return text ? Outcome::Done : Outcome::BadInput;
    }
    const slc::Unit unit = slc::compile_file(file, options.object.front, diag);
    for (const slc::Program& program : unit.programs) {
        const int lanes = options.object.native_only ? slc::native_lanes() : 8;
        out += slc::c_text(program, lanes, options.object);
    }
    return unit.ok() ? Outcome::Done : Outcome::BadInput;
}

std::string object_path(const std::string& name, const Options& options) {
    return options.output.empty() ? options.dir + "/" + name + ".slo" : options.output;
}

Outcome compile(const std::string& file, const Options& options, base::Diag& diag,
                std::string& out) {
    const slc::Unit unit = slc::compile_file(file, options.object.front, diag);
    if (!unit.ok()) {
        // What an earlier run made of this file must not be taken for the result of this one.
        const std::string stem = std::filesystem::path(file).stem().string();
        if (!options.check) {
            ::unlink(object_path(stem, options).c_str());
        }
        return Outcome::BadInput;
    }
    if (!options.output.empty() && unit.programs.size() > 1) {
        diag.report(base::Severity::Error, base::Code::Consistency, {},
                    file + " holds " + std::to_string(unit.programs.size()) +
                        " shaders, but -o names one object");
        return Outcome::BadInput;
    }
    if (unit.programs.empty()) {
        diag.report(base::Severity::Warning, base::Code::NoShader, {}, file + " defines no shader");
    }
    Outcome outcome = Outcome::Done;
    for (const slc::Program& program : unit.programs) {
        if (options.explain) {
            out += slc::facts_text(program, slc::analyse(program));
        }
        if (options.check) {
            continue;
        }
        const std::string path = object_path(program.name, options);
        const Outcome one = slc::build_object(program, options.object, path, diag);
        outcome = std::max(outcome, one);
        if (one == Outcome::Done && !options.quiet) {
            out += path + "\n";
        }
    }
    return outcome;
}

FileResult process(const std::string& file, const Options& options) {
    FileResult result;
    char* text = nullptr;
    std::size_t size = 0;
    std::FILE* stream = ::open_memstream(&text, &size);
    if (!stream) {
        result.outcome = Outcome::BadEnvironment;
        return result;
    }
    {
        base::Diag diag(stream);
        result.outcome = options.dump.empty() ? compile(file, options, diag, result.out)
                                              : dump(file, options, diag, result.out);
        if (diag.had_errors() && diag.last_code() == base::Code::System) {
            result.outcome = Outcome::BadEnvironment; // no preprocessor
        }
    }
    std::fclose(stream);
    result.err.assign(text, size);
    std::free(text);
    return result;
}

Outcome process_all(const Options& options) {
    std::vector<FileResult> results(options.files.size());
    std::atomic<std::size_t> next{0};
    std::mutex mutex;
    std::condition_variable changed;
    const auto work = [&] {
        for (std::size_t i = next++; i < results.size(); i = next++) {
            FileResult result = process(options.files[i], options);
            const std::lock_guard lock(mutex);
            results[i] = std::move(result);
            results[i].finished = true;
            changed.notify_all();
        }
    };
    std::vector<std::jthread> workers;
    for (std::size_t i = 0; i < std::min<std::size_t>(options.jobs, results.size()); ++i) {
        workers.emplace_back(work);
    }
    Outcome worst = Outcome::Done;
    for (FileResult& result : results) {
        std::unique_lock lock(mutex);
        changed.wait(lock, [&] { return result.finished; });
        std::fwrite(result.out.data(), 1, result.out.size(), stdout);
        std::fflush(stdout);
        std::fwrite(result.err.data(), 1, result.err.size(), stderr);
        worst = std::max(worst, result.outcome);
    }
    return worst;
}

} // namespace

int main(int argc, char** argv) {
    Options options;
    const int status = parse_arguments(argc, argv, options);
    if (status >= 0) {
        return status;
    }
    switch (process_all(options)) {
    case Outcome::Done:
        return 0;
    case Outcome::BadInput:
        return 1;
    case Outcome::BadEnvironment:
        return 3;
    }
    return 3;
}
