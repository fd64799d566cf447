// SPDX-License-Identifier: Apache-2.0
#include "tracer/options.h"

#include "runtime/base/option_table.h"
#include "runtime/base/search_path.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <string_view>

namespace trace {

namespace {

enum class Id {
#define RENDER_OPTION(id, name, arguments, metavar, state, help) id,
#include "tracer/options.def"
#undef RENDER_OPTION
};

enum class State { NOW, LATER };

struct Row {
    Id id;
    std::string_view name, arguments, metavar;
    State state;
    std::string_view help;
};

constexpr Row rows[] = {
#define RENDER_OPTION(id, name, arguments, metavar, state, help)                                   \
    {Id::id, name, arguments, metavar, State::state, help},
#include "tracer/options.def"
#undef RENDER_OPTION
};

std::optional<double> to_number(std::string_view text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool whole = error == std::errc() && end == text.data() + text.size();
    return whole && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::optional<int> to_int(std::string_view text) {
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() ? std::optional(value)
                                                                    : std::nullopt;
}

// "3", "7-9"; a minus sign in front belongs to the number.
std::optional<std::pair<int, int>> to_range(std::string_view text) {
    const std::size_t dash = text.size() > 1 ? text.find('-', 1) : std::string_view::npos;
    const std::optional<int> first = to_int(text.substr(0, dash));
    const std::optional<int> last =
        dash == std::string_view::npos ? first : to_int(text.substr(dash + 1));
    return first && last ? std::optional(std::pair(*first, *last)) : std::nullopt;
}

std::optional<std::vector<std::pair<int, int>>> to_ranges(std::string_view text) {
    std::vector<std::pair<int, int>> ranges;
    while (true) {
        const std::size_t comma = text.find(',');
        const auto range = to_range(text.substr(0, comma));
        if (!range) {
            return std::nullopt;
        }
        ranges.push_back(*range);
        if (comma == std::string_view::npos) {
            return ranges;
        }
        text.remove_prefix(comma + 1);
    }
}

bool fits(char letter, std::string_view text) {
    switch (letter) {
    case 'i':
        return to_int(text).has_value();
    case 'f':
        return to_number(text).has_value();
    case 'l':
        return to_ranges(text).has_value();
    default:
        return true;
    }
}

class Parser {
public:
    explicit Parser(std::span<const char* const> arguments) : arguments_(arguments) {}

    ParsedOptions parse() {
        while (at_ < arguments_.size() && result_.error.empty()) {
            const std::string_view argument = arguments_[at_++];
            if (argument == "--") {
                result_.options.files.insert(result_.options.files.end(), arguments_.begin() + at(),
                                             arguments_.end());
                break;
            }
            if (argument.size() > 1 && argument.front() == '-') {
                parse_switch(argument);
            } else {
                result_.options.files.emplace_back(argument);
            }
        }
        return std::move(result_);
    }

private:
    [[nodiscard]] std::ptrdiff_t at() const { return static_cast<std::ptrdiff_t>(at_); }

    void parse_switch(std::string_view argument) {
        const std::size_t equals =
            argument.starts_with("--") ? argument.find('=') : std::string_view::npos;
        const std::string_view name = argument.substr(0, equals);
        const Row* row = std::find_if(std::begin(rows), std::end(rows),
                                      [&](const Row& r) { return r.name == name; });
        if (row == std::end(rows)) {
            result_.error = "unknown switch " + std::string(name);
            return;
        }
        if (equals != std::string_view::npos && row->arguments.size() != 1) {
            result_.error = std::string(name) + " takes no value after '='";
            return;
        }
        values_.clear();
        if (equals != std::string_view::npos) {
            values_.push_back(argument.substr(equals + 1));
        }
        if (take_arguments(*row)) {
            apply(*row);
        }
    }

    bool take_arguments(const Row& row) {
        bool optional = false;
        std::size_t needed = 0;
        for (const char letter : row.arguments) {
            if (letter == '?') {
                optional = true;
                continue;
            }
            if (needed++ == values_.size()) {
                const bool there = at_ < arguments_.size();
                if (optional && (!there || !fits(letter, arguments_[at_]))) {
                    break;
                }
                if (!there) {
                    return fail(row, "needs " + std::string(row.metavar));
                }
                values_.push_back(arguments_[at_++]);
            }
            if (!fits(letter, values_[needed - 1])) {
                return fail(row, "needs " + std::string(row.metavar) + ", not '" +
                                     std::string(values_[needed - 1]) + "'");
            }
        }
        return true;
    }

    bool fail(const Row& row, const std::string& text) {
        result_.error = std::string(row.name) + " " + text;
        return false;
    }

    [[nodiscard]] int integer(std::size_t i) const { return to_int(values_[i]).value_or(0); }
    [[nodiscard]] float number(std::size_t i) const {
        return static_cast<float>(to_number(values_[i]).value_or(0));
    }

    std::optional<std::pair<int, int>> positive_pair(const Row& row) {
        if (integer(0) <= 0 || integer(1) <= 0) {
            fail(row, "needs two positive numbers");
            return std::nullopt;
        }
        return std::pair(integer(0), integer(1));
    }

    void apply_frames(const Row& row) {
        auto ranges = to_ranges(values_[0]).value_or(std::vector<std::pair<int, int>>());
        if (values_.size() > 1) { // -frames A B
            if (ranges.size() != 1 || ranges[0].first != ranges[0].second) {
                fail(row, "takes a list, or the first and the last frame");
                return;
            }
            ranges[0].second = integer(1);
        }
        auto& frames = result_.options.frames;
        frames.insert(frames.end(), ranges.begin(), ranges.end());
    }

    void apply_progress(const Row& row) {
        if (const auto mode = progress_mode(values_[0])) {
            result_.options.progress = *mode;
        } else {
            fail(row, "needs " + std::string(row.metavar));
        }
    }

    void apply_specialise(const Row& row) {
        if (const auto mode = parse_special_mode(values_[0])) {
            result_.options.specialise = *mode;
        } else {
            fail(row, "needs " + std::string(row.metavar));
        }
    }

    void apply_show(const Row& row) {
        RenderOptions& o = result_.options;
        o.show = true;
        if (row.id == Id::servers) {
            o.servers = parse_live_servers(values_[0]);
            if (!o.servers) {
                fail(row, "needs " + std::string(live_servers_form));
            }
        } else if (!values_.empty()) {
            o.show_every = std::max(integer(0), 1);
        }
    }

    void apply(const Row& row) {
        RenderOptions& o = result_.options;
        if (row.state == State::LATER) {
            o.not_yet.emplace_back(row.name);
            return;
        }
        switch (row.id) {
        case Id::threads:
            o.num_threads = integer(0);
            if (o.num_threads < 1) {
                fail(row, "needs a positive number");
            }
            break;
        case Id::res:
            o.res = positive_pair(row);
            break;
        case Id::samples:
            o.samples = positive_pair(row);
            break;
        case Id::var:
            o.variance = {number(0), integer(1), integer(2)};
            if (!(o.variance->variance > 0) || o.variance->least < 1 ||
                o.variance->most < o.variance->least) {
                fail(row, "needs a positive variance and 1 <= MIN <= MAX");
            }
            break;
        case Id::crop:
            o.crop = {number(0), number(1), number(2), number(3)};
            break;
        case Id::frames:
            apply_frames(row);
            break;
        case Id::output:
            o.output = values_[0];
            break;
        case Id::shaders:
            for (std::string& directory : base::expand_search_path(values_[0], o.shader_path)) {
                o.shader_path.push_back(std::move(directory));
            }
            break;
        case Id::shadeops:
            for (std::string& directory : base::expand_search_path(values_[0], o.shadeop_path)) {
                o.shadeop_path.push_back(std::move(directory));
            }
            break;
        case Id::display:
        case Id::servers:
            apply_show(row);
            break;
        case Id::position:
            break; // a page has none
        case Id::silent:
            o.silent = true;
            break;
        case Id::safe:
            o.safe = true;
            break;
        case Id::merge:
            o.merge = true;
            break;
        case Id::resume:
            o.checkpoint.resume = true;
            break;
        case Id::checkpoint:
            o.checkpoint.after_s = static_cast<double>(number(0));
            if (o.checkpoint.after_s < 0) {
                fail(row, "needs a number of seconds");
            }
            break;
        case Id::no_checkpoint:
            o.checkpoint.enabled = false;
            break;
        case Id::checkpoint_dir:
            o.checkpoint.directory = values_[0];
            break;
        case Id::progress90:
            o.progress = ProgressMode::R90000;
            break;
        case Id::verbose:
            o.verbose = true;
            break;
        case Id::option:
            o.rib_texts.emplace_back(values_[0]);
            break;
        case Id::stats:
        case Id::stats_bmrt:
            o.stats = true;
            break;
        case Id::stats_json:
            o.stats_json = values_[0];
            break;
        case Id::profile_shaders:
            o.profile_shaders = values_[0];
            break;
        case Id::report:
            o.report = values_[0];
            break;
        case Id::trace_pixel:
            o.trace_pixels.emplace_back(integer(0), integer(1));
            break;
        case Id::specialise:
            apply_specialise(row);
            break;
        case Id::progress:
            apply_progress(row);
            break;
        case Id::programs:
            o.allow_programs = true;
            break;
        case Id::check_energy:
            o.check_energy = true;
            break;
        case Id::strict:
            o.strict = true;
            break;
        case Id::help:
            o.help = true;
            break;
        case Id::version:
            o.version = true;
            break;
        case Id::radio:
        case Id::radio_error:
        case Id::rsamples:
        case Id::backend:
            break; // LATER
        }
    }

    std::span<const char* const> arguments_;
    std::size_t at_ = 0;
    std::vector<std::string_view> values_; // of the switch in work
    ParsedOptions result_;
};

} // namespace

ParsedOptions parse_options(std::span<const char* const> arguments) {
    return Parser(arguments).parse();
}

std::string usage_text(const std::string& program) {
    constexpr std::size_t column = 30;
    std::string text = "usage: " + program + " [switches] [file.rib ... | -]\n";
    for (const Row& row : rows) {
        const std::string help =
            std::string(row.help) + (row.state == State::LATER ? " (not yet)" : "");
        const base::OptionRow line{row.name, row.arguments, row.metavar, help};
        text += base::option_lines({&line, 1}, column, ' ');
    }
    return text;
}

bool wants_frame(const RenderOptions& options, int frame) {
    return options.frames.empty() ||
           std::any_of(options.frames.begin(), options.frames.end(), [&](const auto& range) {
               return frame >= range.first && frame <= range.second;
           });
}

std::string frame_file_name(const std::string& pattern, int frame) {
    const std::size_t begin = pattern.find('#');
    if (begin == std::string::npos) {
        return pattern;
    }
    const std::size_t end = std::min(pattern.find_first_not_of('#', begin), pattern.size());
    std::string digits = std::to_string(frame);
    if (digits.size() < end - begin) {
        digits.insert(0, end - begin - digits.size(), '0');
    }
    return pattern.substr(0, begin) + digits + pattern.substr(end);
}

} // namespace trace
