// SPDX-License-Identifier: Apache-2.0
#include "slc/options.h"

#include "runtime/base/option_table.h"

#include <charconv>

namespace slc {

namespace {

enum class Id {
#define SLC_OPTION(id, name, arguments, metavar, help) id,
#include "slc/options.def"
#undef SLC_OPTION
};

constexpr base::OptionRow rows[] = {
#define SLC_OPTION(id, name, arguments, metavar, help) {name, arguments, metavar, help},
#include "slc/options.def"
#undef SLC_OPTION
};

bool parse_number(const std::string& text, unsigned lowest, unsigned highest, unsigned& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() && value >= lowest &&
           value <= highest;
}

class Parser {
public:
    explicit Parser(std::span<const char* const> arguments) : arguments_(arguments) {}

    ParsedOptions parse() {
        bool only_files = false;
        while (at_ < arguments_.size() && result_.error.empty()) {
            const std::string_view argument = arguments_[at_++];
            if (only_files || argument.size() < 2 || argument.front() != '-') {
                result_.options.files.emplace_back(argument);
            } else if (argument == "--") {
                only_files = true;
            } else {
                parse_switch(argument);
            }
        }
        check();
        return std::move(result_);
    }

private:
    // The switch an argument begins with; the value that follows it in the same word, if any.
    static const base::OptionRow* row_of(std::string_view argument,
                                         std::optional<std::string>& value) {
        const std::size_t equals =
            argument.starts_with("--") ? argument.find('=') : std::string_view::npos;
        for (const base::OptionRow& row : rows) {
            if (argument.substr(0, equals) == row.name) {
                if (equals != std::string_view::npos) {
                    value = argument.substr(equals + 1);
                }
                return &row;
            }
            if (row.name.size() == 2 && !row.arguments.empty() && argument.starts_with(row.name)) {
                value = argument.substr(2);
                return &row;
            }
        }
        return nullptr;
    }

    void parse_switch(std::string_view argument) {
        std::optional<std::string> value;
        const base::OptionRow* row = row_of(argument, value);
        if (row == nullptr) {
            result_.error = "unknown option " + std::string(argument);
        } else if (row->arguments.empty() && value) {
            result_.error = std::string(row->name) + " takes no value";
        } else if (!row->arguments.empty() && !value && at_ == arguments_.size()) {
            result_.error = std::string(row->name) + " wants a value";
        } else {
            if (!row->arguments.empty() && !value) {
                value = arguments_[at_++];
            }
            apply(static_cast<Id>(row - rows), value.value_or(""));
        }
    }

    void apply(Id id, const std::string& value) {
        Options& o = result_.options;
        unsigned number = 0;
        switch (id) {
        case Id::output:
            o.output = value;
            break;
        case Id::directory:
            o.dir = value;
            break;
        case Id::include:
            o.object.front.include_dirs.push_back(value);
            break;
        case Id::define:
            o.object.front.defines.push_back(value);
            break;
        case Id::shadeops:
            o.shadeop_dirs.push_back(value);
            break;
        case Id::optimise:
            if (!parse_number(value, 0, 3, number)) {
                result_.error = "-O wants 0 to 3";
            }
            o.object.flags.optimisation = static_cast<int>(number);
            break;
        case Id::jobs:
            if (!parse_number(value, 1, 1024, o.jobs)) {
                result_.error = "-j wants a number from 1 to 1024";
            }
            break;
        case Id::quiet:
            o.quiet = true;
            break;
        case Id::check:
            o.check = true;
            break;
        case Id::messages:
            o.json_messages = value == "json";
            o.quiet = o.quiet || o.json_messages; // nothing else on standard output
            if (value != "json" && value != "text") {
                result_.error = "--messages wants text or json, not \"" + value + "\"";
            }
            break;
        case Id::explain:
            o.explain = true;
            break;
        case Id::dump:
            o.dump = value;
            if (value != "c" && !dump_kind(value)) {
                result_.error = "--dump wants tokens, ast, ir, facts or c, not \"" + value + "\"";
            }
            break;
        case Id::native:
            o.object.native_only = true;
            break;
        case Id::compiler:
            o.object.front.preprocessor = value;
            break;
        case Id::target:
            check_target(value);
            break;
        case Id::help:
            o.help = true;
            break;
        case Id::version:
            o.version = true;
            break;
        }
    }

    void check_target(const std::string& value) {
        if (value == "opencl" || value == "both") {
            result_.error = "--target=" + value + ": OpenCL is not part of this version";
        } else if (value != "c") {
            result_.error = "--target wants c, not \"" + value + "\"";
        }
    }

    void check() {
        const Options& o = result_.options;
        if (!result_.error.empty() || o.help || o.version) {
            return;
        }
        if (o.files.empty()) {
            result_.error = "no input file";
        } else if (!o.output.empty() && !o.makes_package() && o.files.size() > 1) {
            result_.error = "-o names one object, but there are " + std::to_string(o.files.size()) +
                            " input files (a package ends in " + std::string(package_suffix) + ")";
        }
    }

    std::span<const char* const> arguments_;
    std::size_t at_ = 0;
    ParsedOptions result_;
};

} // namespace

ParsedOptions parse_options(std::span<const char* const> arguments) {
    return Parser(arguments).parse();
}

std::string usage_text() {
    return "usage: slc [options] file.sl...\n"
           "Compiles RenderMan Shading Language shaders. Each shader becomes <name of the "
           "shader>.slo.\n\n" +
           base::option_lines(rows, 23, '=') +
           "\nExit status: 0 done, 1 errors in the input, 2 wrong usage, 3 the environment "
           "failed.\n";
}

} // namespace slc
