// SPDX-License-Identifier: Apache-2.0
#include "slc/messages.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace slc {

namespace {

constexpr std::size_t max_shown = 160; // of a source line
constexpr std::size_t max_word = 48;   // longer names get no hint

// Source line and caret line, each led by a newline; long lines are cut around the caret.
std::string excerpt(std::string_view line, std::uint32_t col) {
    if (line.empty() || col == 0 || col > line.size() + 1) {
        return {};
    }
    std::size_t first = 0;
    if (col > max_shown - 20) {
        first = col - (max_shown - 20);
    }
    std::string shown(line.substr(first, max_shown));
    std::string caret;
    for (std::size_t i = 0; i + first + 1 < col; ++i) {
        caret += shown[i] == '\t' ? '\t' : ' ';
    }
    for (char& c : shown) { // control characters must not reach the terminal
        const auto u = static_cast<unsigned char>(c);
        c = c != '\t' && (u < 32 || u == 127) ? '?' : c;
    }
    return "\n" + shown + "\n" + caret + "^";
}

// Column after the word, number, string or mark that begins at `col`.
std::uint32_t word_end(std::string_view line, std::uint32_t col) {
    if (col == 0 || col > line.size()) {
        return col + 1;
    }
    const auto in_word = [&](std::size_t i) {
        return std::isalnum(static_cast<unsigned char>(line[i])) != 0 || line[i] == '_';
    };
    std::size_t end = col - 1;
    if (line[end] == '"') {
        const std::size_t close = line.find('"', end + 1);
        return static_cast<std::uint32_t>(
            (close == std::string_view::npos ? line.size() : close + 1) + 1);
    }
    while (end < line.size() && in_word(end)) {
        ++end;
    }
    return static_cast<std::uint32_t>(std::max<std::size_t>(end, col) + 1);
}

std::string json_text(std::string_view text) {
    static constexpr std::string_view hex = "0123456789abcdef";
    std::string out = "\"";
    for (const char c : text) {
        const auto u = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            out += '\\';
            out += c;
        } else if (c == '\n') {
            out += "\\n";
        } else if (u < 32 || u >= 127) { // JSON is UTF-8, sources may be Latin-1
            out += "\\u00";
            out += hex[u >> 4];
            out += hex[u & 15];
        } else {
            out += c;
        }
    }
    return out + "\"";
}

// Levenshtein distance; both words are at most max_word long.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::array<std::size_t, max_word + 1> row{};
    for (std::size_t j = 0; j <= b.size(); ++j) {
        row[j] = j;
    }
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t above = row[j];
            const std::size_t change = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            row[j] = std::min({above + 1, row[j - 1] + 1, change});
            diagonal = above;
        }
    }
    return row[b.size()];
}

} // namespace

void Messages::report(base::Severity severity, base::Code code, Loc loc, std::string_view text) {
    const auto& names = sources_.names();
    if (observer_) {
        const bool placed = loc.file < names.size();
        const std::size_t semicolon = text.find("; ");
        Message message{severity,
                        code,
                        placed ? names[loc.file] : "",
                        placed ? loc.line : 0,
                        placed ? loc.col : 0,
                        0,
                        std::string(text.substr(0, semicolon)),
                        ""};
        if (semicolon != std::string_view::npos) {
            message.note = text.substr(semicolon + 2);
        }
        if (placed) {
            message.end_column = word_end(sources_.line(loc.file, loc.line), loc.col);
        }
        observer_(message);
        return;
    }
    base::SourcePos pos;
    if (loc.file < names.size()) {
        pos = {diag_.file_id(names[loc.file]), loc.line, loc.col};
    }
    diag_.report(severity, code, pos,
                 std::string(text) + excerpt(sources_.line(loc.file, loc.line), loc.col));
}

void Messages::error(Loc loc, std::string_view text, base::Code code) {
    if (++num_errors_ <= max_errors) {
        report(base::Severity::Error, code, loc, text);
    }
    if (num_errors_ == max_errors && observer_) {
        observer_({base::Severity::Error, base::Code::Limit, "", 0, 0, 0,
                   "too many errors, stopped", ""});
    } else if (num_errors_ == max_errors) {
        diag_.report(base::Severity::Error, base::Code::Limit, {}, "too many errors, stopped");
    }
}

void Messages::warning(Loc loc, std::string_view text) {
    if (++num_warnings_ <= max_warnings) {
        report(base::Severity::Warning, base::Code::None, loc, text);
    }
}

bool Messages::first_time(Loc loc, std::string_view text) {
    return seen_
        .insert(std::to_string(loc.file) + ":" + std::to_string(loc.line) + ":" +
                std::to_string(loc.col) + ":" + std::string(text))
        .second;
}

void Messages::error_once(Loc loc, std::string_view text) {
    if (first_time(loc, text)) {
        error(loc, text);
    }
}

void Messages::warning_once(Loc loc, std::string_view text) {
    if (first_time(loc, text)) {
        warning(loc, text);
    }
}

void Messages::system_error(std::string_view text, base::Code code) {
    ++num_errors_;
    if (observer_) {
        observer_({base::Severity::Error, code, "", 0, 0, 0, std::string(text), ""});
    }
    diag_.report(base::Severity::Error, code, {}, text);
}

std::string spelling_hint(std::string_view wrong, std::span<const std::string_view> candidates) {
    if (wrong.size() > max_word) {
        return {};
    }
    std::size_t best = wrong.size() <= 2 ? 1 : 1 + wrong.size() / 4; // largest distance accepted
    std::string_view found;
    for (const std::string_view name : candidates) {
        if (name.empty() || name.size() > max_word || name == wrong) {
            continue;
        }
        const std::size_t distance = edit_distance(wrong, name);
        if (distance < best + (found.empty() ? 1 : 0) && distance < name.size()) {
            best = distance;
            found = name;
        }
    }
    return found.empty() ? std::string() : ", did you mean " + quoted(found) + "?";
}

std::string json_line(const Message& message) {
    std::string out = "{\"file\": " + json_text(message.file);
    const auto number = [&](const char* name, std::uint32_t value) {
        out += value > 0 ? std::string(", \"") + name + "\": " + std::to_string(value) : "";
    };
    number("line", message.line);
    number("column", message.column);
    number("endColumn", message.end_column);
    out += ", \"severity\": " + json_text(base::severity_name(message.severity)) +
           ", \"code\": " + json_text(base::code_name(message.code)) +
           ", \"text\": " + json_text(message.text);
    out += message.note.empty() ? "" : ", \"note\": " + json_text(message.note);
    return out + "}";
}

std::string quoted(std::string_view name) {
    return "'" + std::string(name.substr(0, 100)) + "'";
}

} // namespace slc
