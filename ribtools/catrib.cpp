// SPDX-License-Identifier: Apache-2.0
// catrib [--binary|--text] [--gzip] [-o FILE] [file.rib... | -]: RIB of any form to any other.
//
// In: RIB as text, binary, either gzipped, mixed at will. Out: one stream of the form asked for,
// every number to its last bit; or, with --check, only the messages a renderer would give. Exit
// codes: 0 done, 1 errors in the input, 2 wrong usage, 3 the environment failed.
#include "ribtools/reader.h"
#include "ribtools/rib_convert.h"
#include "ribtools/rib_gzip.h"
#include "runtime/base/option_table.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <string>
#include <string_view>
#include <unistd.h>
#include <vector>

namespace {

constexpr int exit_done = 0, exit_input = 1, exit_usage = 2, exit_environment = 3;

enum class Id {
#define CATRIB_OPTION(id, name, arguments, metavar, state, help) id,
#include "ribtools/catrib_options.def"
};

struct Row {
    Id id;
    std::string_view name, arguments, metavar, help;
};

constexpr Row rows[] = {
#define CATRIB_OPTION(id, name, arguments, metavar, state, help)                                   \
    {Id::id, name, arguments, metavar, help},
#include "ribtools/catrib_options.def"
};

struct Options {
    rib::WriteOptions write;
    rib::ConvertOptions convert;
    bool gzip = false, check = false, help = false, version = false;
    std::string output;
    std::vector<std::string> files;
    std::string error; // not empty: wrong usage
};

void apply(Options& o, const Row& row, std::string_view value) {
    constexpr int most_indent = 32;
    switch (row.id) {
    case Id::text:
        o.write.form = rib::RibForm::Text;
        break;
    case Id::binary:
        o.write.form = rib::RibForm::Binary;
        break;
    case Id::gzip:
        o.gzip = true;
        break;
    case Id::output:
        o.output = value;
        break;
    case Id::indent: {
        int& n = o.write.indent;
        const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), n);
        if (error != std::errc() || end != value.data() + value.size() || n < 0 ||
            n > most_indent) {
            o.error = "--indent needs a number from 0 to " + std::to_string(most_indent) +
                      ", not '" + std::string(value) + "'";
        }
        break;
    }
    case Id::expand:
        o.convert.expand = true;
        break;
    case Id::check:
        o.check = true;
        break;
    case Id::help:
        o.help = true;
        break;
    case Id::version:
        o.version = true;
        break;
    }
}

// argv[i] is a switch; i moves to its last argument.
void parse_switch(Options& o, int argc, char** argv, int& i) {
    const std::string_view arg = argv[i];
    const std::size_t equals = arg.starts_with("--") ? arg.find('=') : std::string_view::npos;
    const std::string_view name = arg.substr(0, equals);
    const Row* row = std::find_if(std::begin(rows), std::end(rows),
                                  [&](const Row& r) { return r.name == name; });
    if (row == std::end(rows)) {
        o.error = "unknown switch " + std::string(name);
        return;
    }
    std::string_view value;
    if (equals != std::string_view::npos) {
        value = arg.substr(equals + 1);
    } else if (!row->arguments.empty() && i + 1 < argc) {
        value = argv[++i];
    }
    if (value.empty() != row->arguments.empty()) {
        o.error = std::string(name) + (value.empty() ? " needs " + std::string(row->metavar)
                                                     : std::string(" takes no value"));
        return;
    }
    apply(o, *row, value);
}

Options parse_options(int argc, char** argv) {
    Options o;
    bool only_files = false;
    for (int i = 1; i < argc && o.error.empty(); ++i) {
        const std::string_view arg = argv[i];
        if (!only_files && arg == "--") {
            only_files = true;
        } else if (!only_files && arg.size() > 1 && arg.front() == '-') {
            parse_switch(o, argc, argv, i);
        } else {
            o.files.emplace_back(arg);
        }
    }
    if (o.files.empty()) {
        o.files.emplace_back("-");
    }
    return o;
}

std::string usage_text() {
    constexpr std::size_t column = 16;
    std::string text = "usage: catrib [switches] [file.rib ... | -]\n";
    for (const Row& row : rows) {
        const base::OptionRow line{row.name, row.arguments, row.metavar, row.help};
        text += base::option_lines({&line, 1}, column, ' ');
    }
    return text;
}

class NoBackend final : public rib::Backend {
public:
    bool render(std::unique_ptr<rib::Scene>) override { return true; }
    bool make_texture(const rib::TextureRequest&) override { return true; }
};

int check(const Options& options) {
    base::Diag diag;
    NoBackend backend;
    rib::Reader reader(backend, diag, {});
    for (const std::string& file : options.files) {
        if (reader.read_file(file) == rib::ReadStatus::Environment) {
            return exit_environment;
        }
    }
    return diag.had_errors() ? exit_input : exit_done;
}

int convert(const Options& options) {
    base::Diag diag;
    std::unique_ptr<rib::ByteSink> sink =
        options.output.empty() ? rib::stdout_sink() : rib::file_sink(options.output);
    if (options.gzip) {
        sink = rib::gzip_sink(std::move(sink));
    }
    rib::Writer writer(*sink, options.write);
    rib::Converter converter(writer, diag, options.convert);
    for (const std::string& file : options.files) {
        // A file that stands for all of the input must not lack a part of it.
        if (converter.convert_file(file) == rib::ReadStatus::Environment) {
            return exit_environment;
        }
        writer.flush();
    }
    if (!sink->finish()) {
        diag.report(base::Severity::Severe, base::Code::System, {},
                    "cannot write " +
                        (options.output.empty() ? "standard output" : options.output) + ": " +
                        sink->error());
        return exit_environment;
    }
    return diag.had_errors() ? exit_input : exit_done;
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parse_options(argc, argv);
    if (!options.error.empty()) {
        std::fprintf(stderr, "catrib: %s\n%s", options.error.c_str(), usage_text().c_str());
        return exit_usage;
    }
    if (options.help) {
        std::fputs(usage_text().c_str(), stdout);
        return exit_done;
    }
    if (options.version) {
        std::puts("catrib (Perigee) " PERIGEE_VERSION);
        return exit_done;
    }
    if (options.check) {
        return check(options);
    }
    const bool is_text = options.write.form == rib::RibForm::Text && !options.gzip;
    if (!is_text && options.output.empty() && ::isatty(STDOUT_FILENO) != 0) {
        std::fputs("catrib: this is not for a terminal; use -o FILE or redirect the output\n",
                   stderr);
        return exit_usage;
    }
    return convert(options);
}
