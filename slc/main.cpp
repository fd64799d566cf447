// SPDX-License-Identifier: Apache-2.0
// The program slc: compiles SL files into shader objects, or all of them into one package; --help
// lists the options. Files are compiled by several threads; what each has to say is printed in the
// order of the command line.
#include "runtime/base/ar_file.h"
#include "runtime/base/file.h"
#include "runtime/base/interrupt.h"
#include "runtime/base/seal.h"
#include "sl_fingerprint.h"
#include "slc/explain.h"
#include "slc/messages.h"
#include "slc/options.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdio>
#include <filesystem>
#include <map>
#include <mutex>
#include <string_view>
#include <thread>
#include <unistd.h>

namespace {

using slc::Options;
using slc::Outcome;

// What one file had to say and what became of it.
struct FileResult {
    Outcome outcome = Outcome::Done;
    std::string out;
    base::Diag diag{base::Diag::Deferred::Yes};
    std::vector<std::pair<std::string, std::string>> members; // of the package: name, object
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

Outcome write_file(const std::string& path, std::string_view bytes, base::Diag& diag) {
    const std::string error = base::write_file_atomically(path, bytes);
    if (!error.empty()) {
        diag.report(base::Severity::Error, base::Code::NoFile, {}, error);
    }
    return error.empty() ? Outcome::Done : Outcome::BadEnvironment;
}

// One shader of a file: into its object, or to the members of the package.
Outcome build(const slc::Program& program, const Options& options, FileResult& result) {
    const std::string path = object_path(program.name, options);
    if (!options.makes_package()) {
        ::unlink(path.c_str()); // must not pass for the result of this compilation
    }
    slc::BuiltObject built = slc::build_object(program, options.object, result.diag);
    if (built.outcome != Outcome::Done) {
        return built.outcome;
    }
    if (options.makes_package()) {
        result.members.emplace_back(program.name + ".slo", std::move(built.bytes));
        return Outcome::Done;
    }
    const Outcome outcome = write_file(path, built.bytes, result.diag);
    if (outcome == Outcome::Done && !options.quiet) {
        result.out += path + "\n";
    }
    return outcome;
}

Outcome compile(const std::string& file, const Options& options, FileResult& result) {
    base::Diag& diag = result.diag;
    const slc::Unit unit = slc::compile_file(file, options.object.front, diag);
    if (!unit.ok()) {
        // What an earlier run made of this file must not be taken for the result of this one.
        const std::string stem = std::filesystem::path(file).stem().string();
        if (!options.check) {
            ::unlink(object_path(stem, options).c_str());
        }
        return Outcome::BadInput;
    }
    if (!options.output.empty() && !options.makes_package() && unit.programs.size() > 1) {
        diag.report(base::Severity::Error, base::Code::Consistency, {},
                    file + " holds " + std::to_string(unit.programs.size()) +
                        " shaders, but -o names one object");
        return Outcome::BadInput;
    }
    if (unit.programs.empty()) {
        const std::string text = file + " defines no shader";
        if (options.object.front.on_message) {
            options.object.front.on_message({base::Severity::Warning, base::Code::NoShader, file, 0,
                                             0, 0, "no shader is defined", ""});
        } else {
            diag.report(base::Severity::Warning, base::Code::NoShader, {}, text);
        }
    }
    Outcome outcome = Outcome::Done;
    for (const slc::Program& program : unit.programs) {
        if (options.explain) {
            result.out += slc::explain_text(program, options.object.front);
        }
        if (!options.check) {
            outcome = std::max(outcome, build(program, options, result));
        }
    }
    return outcome;
}

// An object made before, as a member of the package.
Outcome take_object(const std::string& file, FileResult& result) {
    auto bytes = base::read_file(file);
    if (!bytes || base::check_seal(*bytes, SL_ABI_FINGERPRINT) != base::SealState::Good) {
        result.diag.report(base::Severity::Error, base::Code::BadFile, {},
                           file + " is not a whole shader object of this version of slc");
        return Outcome::BadInput;
    }
    result.members.emplace_back(std::filesystem::path(file).filename().string(), std::move(*bytes));
    return Outcome::Done;
}

void process(const std::string& file, const Options& given, FileResult& result) {
    Options options = given;
    if (options.json_messages) {
        options.object.front.on_message = [&result](const slc::Message& message) {
            result.out += slc::json_line(message) + "\n";
        };
    }
    if (!options.dump.empty()) {
        result.outcome = dump(file, options, result.diag, result.out);
    } else if (options.makes_package() && file.ends_with(".slo")) {
        result.outcome = take_object(file, result);
    } else {
        result.outcome = compile(file, options, result);
    }
    if (result.diag.had_errors() && result.diag.last_code() == base::Code::System) {
        result.outcome = Outcome::BadEnvironment; // no preprocessor
    }
}

// Shaders in the order of their names, so that the same shaders give the same bytes.
Outcome write_package(std::vector<FileResult>& results, const Options& options, base::Diag& diag) {
    std::map<std::string, std::string> members;
    for (FileResult& result : results) {
        for (auto& [name, object] : result.members) {
            if (!members.try_emplace(name, std::move(object)).second) {
                diag.report(base::Severity::Error, base::Code::Consistency, {},
                            "two shaders would be " + name + " in " + options.output);
                return Outcome::BadInput;
            }
        }
    }
    const std::vector<std::pair<std::string, std::string>> sorted(members.begin(), members.end());
    const Outcome outcome = write_file(options.output, base::ar_bytes(sorted), diag);
    if (outcome == Outcome::Done && !options.quiet) {
        std::printf("%s\n", options.output.c_str());
    }
    return outcome;
}

Outcome process_all(const Options& options) {
    std::vector<FileResult> results(options.files.size());
    std::atomic<std::size_t> next{0};
    std::mutex mutex;
    std::condition_variable changed;
    const auto work = [&] {
        for (std::size_t i = next++; i < results.size(); i = next++) {
            if (!base::is_interrupted()) {
                process(options.files[i], options, results[i]);
            }
            const std::lock_guard lock(mutex);
            results[i].finished = true;
            changed.notify_all();
        }
    };
    std::vector<std::jthread> workers;
    for (std::size_t i = 0; i < std::min<std::size_t>(options.jobs, results.size()); ++i) {
        workers.emplace_back(work);
    }
    base::Diag diag;
    Outcome worst = Outcome::Done;
    for (FileResult& result : results) {
        std::unique_lock lock(mutex);
        changed.wait(lock, [&] { return result.finished; });
        std::fwrite(result.out.data(), 1, result.out.size(), stdout);
        std::fflush(stdout);
        result.diag.deliver(diag);
        worst = std::max(worst, result.outcome);
    }
    if (options.makes_package() && !options.check && options.dump.empty()) {
        ::unlink(options.output.c_str()); // must not pass for the result of this run
        worst = worst == Outcome::Done ? write_package(results, options, diag) : worst;
    }
    return worst;
}

int exit_code(Outcome outcome) {
    switch (outcome) {
    case Outcome::Done:
        return 0;
    case Outcome::BadInput:
        return 1;
    case Outcome::BadEnvironment:
        return 3;
    }
    return 3;
}

} // namespace

int main(int argc, char** argv) {
    slc::ParsedOptions parsed = slc::parse_options({argv + (argc > 0 ? 1 : 0), argv + argc});
    if (!parsed.error.empty()) {
        std::fprintf(stderr, "slc: %s; see slc --help\n", parsed.error.c_str());
        return 2;
    }
    if (parsed.options.help) {
        std::fputs(slc::usage_text().c_str(), stdout);
        return 0;
    }
    if (parsed.options.version) {
        std::printf("slc (Perigee) %s\n", PERIGEE_VERSION);
        return 0;
    }
    base::catch_interrupts();
    parsed.options.object.front.cancelled = base::is_interrupted;
    parsed.options.object.front.standard_headers = slc::standard_headers();
    base::ShadeopLibrary shadeops(parsed.options.shadeop_dirs);
    slc::use_shadeops(parsed.options.object, shadeops);
    base::Diag diag;
    slc::report_shadeops(shadeops, diag);
    const Outcome outcome = process_all(parsed.options);
    base::finish_interrupt();
    return exit_code(outcome);
}
