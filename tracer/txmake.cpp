// SPDX-License-Identifier: Apache-2.0
// txmake [switches] picture ... result: makes textures, environments and shadow maps ahead of time,
// as the requests MakeTexture ... of RIB do while it is read. Exit codes: 0 done, 1 a picture
// cannot be read, 2 wrong usage, 3 the environment failed.
#include "runtime/base/option_table.h"
#include "tracer/texture_make.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

namespace {

constexpr int exit_done = 0, exit_input = 1, exit_usage = 2, exit_environment = 3;

enum class Id {
#define TXMAKE_OPTION(id, name, arguments, metavar, help) id##_,
#include "tracer/txmake_options.def"
};

struct Row {
    Id id;
    std::string_view name, arguments, metavar, help;
};

constexpr Row rows[] = {
#define TXMAKE_OPTION(id, name, arguments, metavar, help)                                          \
    {Id::id##_, name, arguments, metavar, help},
#include "tracer/txmake_options.def"
};

struct Options {
    trace::MakeRequest make;
    bool newer = false, verbose = false, help = false, version = false;
    std::vector<std::string> files;
    std::string error; // not empty: wrong usage
};

double number(Options& o, const Row& row, std::string_view value) {
    double x = 0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), x);
    if (error != std::errc() || end != value.data() + value.size()) {
        o.error = std::string(row.name) + " needs a number, not '" + std::string(value) + "'";
    }
    return x;
}

// A word of those that the metavar lists.
std::string word(Options& o, const Row& row, std::string_view value) {
    for (std::string_view rest = row.metavar; !rest.empty();) {
        const std::size_t n = std::min(rest.find('|'), rest.size());
        if (rest.substr(0, n) == value) {
            return std::string(value);
        }
        rest.remove_prefix(std::min(n + 1, rest.size()));
    }
    o.error = std::string(row.name) + " needs one of " + std::string(row.metavar) + ", not '" +
              std::string(value) + "'";
    return "";
}

void apply(Options& o, const Row& row, std::string_view value) {
    trace::MakeRequest& m = o.make;
    switch (row.id) {
    case Id::mode_:
        m.smode = m.tmode = word(o, row, value);
        break;
    case Id::smode_:
        m.smode = word(o, row, value);
        break;
    case Id::tmode_:
        m.tmode = word(o, row, value);
        break;
    case Id::filter_:
        m.filter = value;
        break;
    case Id::swidth_:
    case Id::twidth_:
        number(o, row, value);
        break;
    case Id::resize_:
        m.resize = word(o, row, value) == "up";
        break;
    case Id::envlatl_:
        m.kind = trace::MapKind::LatLong;
        break;
    case Id::envcube_:
        m.kind = trace::MapKind::Cube;
        break;
    case Id::fov_:
        m.fov_deg = number(o, row, value);
        break;
    case Id::shadow_:
        m.kind = trace::MapKind::Shadow;
        break;
    case Id::byte_:
        m.format = "uint8";
        break;
    case Id::short_:
        m.format = "uint16";
        break;
    case Id::half_:
        m.format = "half";
        break;
    case Id::float_:
        m.format = "float";
        break;
    case Id::compression_:
        m.compression = word(o, row, value);
        break;
    case Id::nomipmap_:
        m.mipmap = false;
        break;
    case Id::newer_:
        o.newer = true;
        break;
    case Id::output_:
        m.target = value;
        break;
    case Id::verbose_:
        o.verbose = true;
        break;
    case Id::help_:
        o.help = true;
        break;
    case Id::version_:
        o.version = true;
        break;
    }
}

Options parse_options(int argc, char** argv) {
    Options o;
    for (int i = 1; i < argc && o.error.empty(); ++i) {
        const std::string_view arg = argv[i];
        if (arg.size() < 2 || arg.front() != '-') {
            o.files.emplace_back(arg);
            continue;
        }
        const Row* row = std::ranges::find(rows, arg, &Row::name);
        if (row == std::end(rows)) {
            o.error = "unknown switch " + std::string(arg);
        } else if (!row->arguments.empty() && i + 1 >= argc) {
            o.error = std::string(arg) + " needs " + std::string(row->metavar);
        } else {
            apply(o, *row, row->arguments.empty() ? "" : argv[++i]);
        }
    }
    if (o.make.target.empty() && o.files.size() > 1) {
        o.make.target = o.files.back();
        o.files.pop_back();
    }
    o.make.sources = o.files;
    return o;
}

std::string usage_problem(const Options& o) {
    const std::size_t n = o.files.size();
    if (!o.error.empty()) {
        return o.error;
    }
    if (n == 0 || o.make.target.empty()) {
        return "a picture and a result are needed";
    }
    if (o.make.kind == trace::MapKind::Cube && n != 6) {
        return "-envcube needs six pictures, not " + std::to_string(n);
    }
    const bool takes_one =
        o.make.kind == trace::MapKind::Texture || o.make.kind == trace::MapKind::LatLong;
    return takes_one && n > 1 ? "one picture makes one texture, not " + std::to_string(n) : "";
}

std::string usage_text() {
    constexpr std::size_t column = 24;
    std::string text = "usage: txmake [switches] picture ... result\n";
    for (const Row& row : rows) {
        const base::OptionRow line{row.name, row.arguments, row.metavar, row.help};
        text += base::option_lines({&line, 1}, column, ' ');
    }
    return text;
}

bool is_newer(const trace::MakeRequest& request) {
    std::error_code error;
    const auto made = std::filesystem::last_write_time(request.target, error);
    return !error && std::ranges::all_of(request.sources, [&](const std::string& source) {
        const auto time = std::filesystem::last_write_time(source, error);
        return !error && time < made;
    });
}

int make(const Options& o) {
    if (o.newer && is_newer(o.make)) {
        if (o.verbose) {
            std::fprintf(stderr, "txmake: %s is newer than what it is made of\n",
                         o.make.target.c_str());
        }
        return exit_done;
    }
    const trace::MakeOutcome outcome = trace::make_map(o.make);
    for (const std::string& note : outcome.notes) {
        std::fprintf(stderr, "txmake: warning: %s\n", note.c_str());
    }
    if (!outcome.made) {
        std::fprintf(stderr, "txmake: error: %s\n", outcome.error.c_str());
        return outcome.environment ? exit_environment : exit_input;
    }
    if (o.verbose) {
        std::fprintf(stderr, "txmake: made %s\n", o.make.target.c_str());
    }
    return exit_done;
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parse_options(argc, argv);
    if (options.help) {
        std::fputs(usage_text().c_str(), stdout);
        return exit_done;
    }
    if (options.version) {
        std::puts("txmake (Perigee) " PERIGEE_VERSION);
        return exit_done;
    }
    if (const std::string problem = usage_problem(options); !problem.empty()) {
        std::fprintf(stderr, "txmake: %s\n%s", problem.c_str(), usage_text().c_str());
        return exit_usage;
    }
    return make(options);
}
