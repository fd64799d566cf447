// SPDX-License-Identifier: Apache-2.0
// Runs `cc -E` on text given on standard input; a leading line marker gives it its name, -iquote
// its directory.
#include "slc/preprocess.h"

#include "slc/process.h"

#include <algorithm>
#include <charconv>

namespace slc {

namespace {

std::vector<std::string> arguments(const std::string& compiler, const std::string& name,
                                   const CompileOptions& options) {
    const std::string directory = directory_of(name);
    std::vector<std::string> argv = {
        compiler,      "-E",      "-x",        "c",
        "-std=gnu99",  "-undef",  "-nostdinc", "-fno-diagnostics-show-option",
        "-DPERIGEE=1", "-DBMRT=1"};
    for (const std::string& define : options.defines) {
        argv.push_back("-D" + define);
    }
    argv.push_back("-iquote");
    argv.push_back(directory);
    for (const std::string& dir : options.include_dirs) {
        argv.push_back("-I" + dir);
    }
    argv.push_back("-I" + directory); // <f> looks beside the file last (sl.md 1.2)
    if (!options.standard_headers.empty()) {
        argv.insert(argv.end(), {"-idirafter", options.standard_headers});
    }
    argv.push_back("-");
    return argv;
}

// As the text of a line marker: a C string.
std::string escaped(std::string_view name) {
    std::string out;
    for (const char c : name) {
        if (c == '"' || c == '\\') {
            out += '\\';
        }
        out += c == '\n' ? '?' : c;
    }
    return out;
}

// One "file:line:col: kind: text" line of the compiler.
struct CcMessage {
    std::string_view file, kind, text;
    std::uint32_t line = 0, col = 0;
};

bool read_number(std::string_view& rest, std::uint32_t& value) {
    const auto [end, ec] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
    if (ec != std::errc() || end == rest.data() + rest.size() || *end != ':') {
        return false;
    }
    rest.remove_prefix(static_cast<std::size_t>(end - rest.data()) + 1);
    return true;
}

std::optional<CcMessage> decode(std::string_view line) {
    for (const std::string_view kind : {"fatal error", "error", "warning"}) {
        const std::string mark = ": " + std::string(kind) + ": ";
        const std::size_t at = line.find(mark);
        if (at == std::string_view::npos) {
            continue;
        }
        CcMessage message;
        message.kind = kind;
        message.text = line.substr(at + mark.size());
        std::string place(line.substr(0, at));
        const std::size_t second = place.rfind(':');
        const std::size_t first = second == std::string::npos || second == 0
                                      ? std::string::npos
                                      : place.rfind(':', second - 1);
        if (first == std::string::npos) {
            continue;
        }
        place += ':';
        std::string_view numbers = std::string_view(place).substr(first + 1);
        if (!read_number(numbers, message.line) || !read_number(numbers, message.col)) {
            continue;
        }
        message.file = line.substr(0, first);
        return message;
    }
    return std::nullopt;
}

// Reports what the compiler said; false when there was an error.
bool relay(std::string_view err, Messages& messages) {
    bool ok = true;
    while (!err.empty()) {
        const std::size_t end = err.find('\n');
        const auto message = decode(err.substr(0, end));
        err = end == std::string_view::npos ? std::string_view() : err.substr(end + 1);
        if (!message) {
            continue;
        }
        if (message->text.starts_with("missing terminating")) {
            continue; // a string without end: the lexer says it, as the error it is
        }
        const Loc loc{messages.sources().add(message->file), message->line, message->col};
        // sl.md 1.2: unknown directives are only warned about.
        // Words that do not paste to one stand side by side, as with older preprocessors.
        const bool harmless = message->text.starts_with("invalid preprocessing directive") ||
                              message->text.starts_with("pasting ");
        constexpr std::string_view not_found = ": No such file or directory";
        if (message->kind == "warning" || harmless) {
            messages.warning(loc, message->text);
            continue;
        }
        ok = false;
        if (message->text.ends_with(not_found)) {
            const auto name = message->text.substr(0, message->text.size() - not_found.size());
            messages.error(loc,
                           "included file " + quoted(name) +
                               " is not found; -I names the folder it is in",
                           base::Code::NoFile);
            continue;
        }
        messages.error(loc, message->text, base::Code::Syntax);
    }
    return ok;
}

ProcessResult run_first_found(const std::string& input, const std::string& name,
                              const CompileOptions& options) {
    std::vector<std::string> candidates = {"cc", "gcc", "clang"};
    if (!options.preprocessor.empty()) {
        candidates = {options.preprocessor};
    }
    ProcessSettings settings;
    settings.cancelled = options.cancelled;
    for (const std::string& compiler : candidates) {
        ProcessResult result = run_process(arguments(compiler, name, options), input, settings);
        if (result.started) {
            return result;
        }
    }
    return {};
}

} // namespace

std::optional<std::string> preprocess(std::string_view text, const std::string& name,
                                      const CompileOptions& options, Messages& messages) {
    const std::string input = "# 1 \"" + escaped(name) + "\"\n" + std::string(text);
    ProcessResult result = run_first_found(input, name, options);
    if (!result.started) {
        messages.system_error(
            "shaders need a C compiler as preprocessor, and none was found (tried " +
                (options.preprocessor.empty() ? std::string("cc, gcc, clang")
                                              : options.preprocessor) +
                "); install one: apt-get install gcc libc6-dev",
            base::Code::System);
        return std::nullopt;
    }
    if (result.cancelled) {
        messages.count_error();
        return std::nullopt;
    }
    const bool ok = relay(result.err, messages);
    if (result.cut_off || result.exit_code < 0) {
        messages.error(Loc{0, 1, 1},
                       "the preprocessor was stopped: its output or its time has no bound",
                       base::Code::Limit);
        return std::nullopt;
    }
    if (!ok) {
        return std::nullopt;
    }
    if (result.exit_code != 0 && messages.num_errors() == 0 &&
        result.err.find("invalid preprocessing directive") == std::string::npos &&
        result.err.find(": error: pasting ") == std::string::npos) {
        messages.system_error("the preprocessor failed: " + result.err.substr(0, 500),
                              base::Code::System);
        return std::nullopt;
    }
    return std::move(result.out);
}

} // namespace slc
