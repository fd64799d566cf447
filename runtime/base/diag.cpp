// SPDX-License-Identifier: Apache-2.0
#include "runtime/base/diag.h"

#include <algorithm>

namespace base {

namespace {
// Kept for reports; a hostile file must not grow it without bound.
constexpr std::size_t max_log = 10'000;
constexpr std::size_t max_places = 8;
constexpr std::size_t no_record = ~std::size_t{0};

// "file:line:col" or "file:byte offset", as far as known.
std::string place_text(const std::string& file, SourcePos pos) {
    std::string place = file;
    if (!file.empty() && pos.is_byte()) {
        place += ":" + place_name(pos);
    } else if (!file.empty() && pos.line > 0) {
        place += ":" + std::to_string(pos.line);
        place += pos.col > 0 ? ":" + std::to_string(pos.col) : "";
    }
    return place;
}
} // namespace

std::string_view severity_name(Severity severity) {
    switch (severity) {
    case Severity::Info:
        return "info";
    case Severity::Warning:
        return "warning";
    case Severity::Error:
        return "error";
    case Severity::Severe:
        return "severe";
    }
    return "";
}

std::string place_name(SourcePos pos) {
    return pos.is_byte() ? "byte " + std::to_string(pos.byte())
                         : "line " + std::to_string(pos.line);
}

std::string kind_of(std::string_view text) {
    std::string kind;
    for (const char c : text) {
        const bool digit = (c >= '0' && c <= '9') || c == '.' || c == '-';
        if (!digit || !kind.ends_with('#')) {
            kind += digit ? '#' : c;
        }
    }
    return kind;
}

std::string_view code_name(Code code) {
    switch (code) {
#define DIAG_CODE(name, value, ri_name)                                                            \
    case Code::name:                                                                               \
        return ri_name;
#include "runtime/base/diag_codes.def"
#undef DIAG_CODE
    }
    return "";
}

std::uint32_t Diag::file_id(std::string_view name) {
    const std::lock_guard lock(mutex_);
    const auto it = std::find(files_.begin(), files_.end(), name);
    if (it != files_.end()) {
        return static_cast<std::uint32_t>(it - files_.begin()) + 1;
    }
    files_.emplace_back(name);
    return static_cast<std::uint32_t>(files_.size());
}

std::string Diag::file_name(std::uint32_t id) const {
    const std::lock_guard lock(mutex_);
    return id == 0 || id > files_.size() ? std::string() : files_[id - 1];
}

void Diag::report(Severity severity, Code code, SourcePos pos, std::string_view text) {
    if (deferred_) {
        keep({}, severity, code, pos, text);
        return;
    }
    const std::string place = place_text(file_name(pos.file_id), pos);
    const std::lock_guard lock(mutex_);
    record(severity, code, place, text);
    say(severity, code, place, text);
}

void Diag::report_once(std::string_view key, Severity severity, Code code, SourcePos pos,
                       std::string_view text) {
    if (deferred_) {
        keep(key, severity, code, pos, text);
        return;
    }
    const std::string place = place_text(file_name(pos.file_id), pos);
    const std::lock_guard lock(mutex_);
    const auto [it, is_new] = seen_.try_emplace(std::string(key), no_record);
    if (is_new) {
        it->second = record(severity, code, place, text);
        say(severity, code, place, text);
    } else if (it->second != no_record) {
        ++records_[it->second].count;
    }
}

bool Diag::report_few(std::string_view key, std::uint64_t most, Severity severity, Code code,
                      SourcePos pos, std::string_view text) {
    if (deferred_) {
        keep({}, severity, code, pos, text);
        return true;
    }
    const std::string place = place_text(file_name(pos.file_id), pos);
    const std::lock_guard lock(mutex_);
    record(severity, code, place, text);
    auto it = repeated_index_.find(std::string(key));
    if (it == repeated_index_.end()) {
        if (repeated_.size() >= max_log) {
            say(severity, code, place, text);
            return true;
        }
        it = repeated_index_.emplace(key, repeated_.size()).first;
        repeated_.push_back({severity, {}, std::string(text), 0, 0});
    }
    Repeated& repeated = repeated_[it->second];
    if (repeated.num_said < most) {
        ++repeated.num_said;
        say(severity, code, place, text);
        return true;
    }
    ++repeated.num_quiet;
    repeated.last_place = place;
    note(severity, code);
    return false;
}

void Diag::tell_repeated() {
    const std::lock_guard lock(mutex_);
    for (Repeated& r : repeated_) {
        if (r.num_quiet > 0) {
            print(r.severity, r.last_place,
                  std::to_string(r.num_quiet) + " more like this up to here: " + r.text);
            r.num_quiet = 0;
        }
    }
}

void Diag::say(Severity severity, Code code, const std::string& place, std::string_view text) {
    note(severity, code);
    print(severity, place, text);
}

void Diag::note(Severity severity, Code code) {
    ++counts_[static_cast<int>(severity)];
    if (code != Code::None) {
        last_ = code;
    }
    if (handler_ == ErrorHandler::Abort && severity >= Severity::Error) {
        abort_ = true;
    }
}

void Diag::print(Severity severity, const std::string& place, std::string_view text) {
    if (handler_ == ErrorHandler::Ignore || severity < threshold_) {
        return;
    }
    std::string line = place.empty() ? "perigee" : place;
    line += ": ";
    line += severity_name(severity);
    line += ": ";
    line += text;
    std::fprintf(out_, "%s\n", line.c_str());
    if (log_.size() < max_log) {
        log_.push_back(std::move(line));
    }
}

// The record of a message, counted; no_record when there are too many already.
std::size_t Diag::record(Severity severity, Code code, const std::string& place,
                         std::string_view text) {
    std::string key(text);
    key += static_cast<char>(severity);
    key += static_cast<char>(code);
    auto it = record_of_text_.find(key);
    if (it == record_of_text_.end()) {
        if (records_.size() >= max_log) {
            return no_record;
        }
        it = record_of_text_.emplace(std::move(key), records_.size()).first;
        records_.push_back({severity, code, std::string(text), 0, {}});
    }
    MessageRecord& found = records_[it->second];
    ++found.count;
    if (!place.empty() && found.places.size() < max_places &&
        std::find(found.places.begin(), found.places.end(), place) == found.places.end()) {
        found.places.push_back(place);
    }
    return it->second;
}

void Diag::keep(std::string_view key, Severity severity, Code code, SourcePos pos,
                std::string_view text) {
    const std::string file = file_name(pos.file_id);
    const std::lock_guard lock(mutex_);
    ++counts_[static_cast<int>(severity)];
    if (code != Code::None) {
        last_ = code;
    }
    kept_.push_back({std::string(key), file, std::string(text), pos, severity, code});
}

void Diag::deliver(Diag& to) {
    std::vector<Kept> kept;
    {
        const std::lock_guard lock(mutex_);
        kept.swap(kept_);
    }
    for (Kept& message : kept) {
        message.pos.file_id = message.file.empty() ? 0 : to.file_id(message.file);
        if (message.key.empty()) {
            to.report(message.severity, message.code, message.pos, message.text);
        } else {
            to.report_once(message.key, message.severity, message.code, message.pos, message.text);
        }
    }
}

void Diag::set_handler(ErrorHandler handler) {
    const std::lock_guard lock(mutex_);
    handler_ = handler;
}

void Diag::clear_abort() {
    const std::lock_guard lock(mutex_);
    abort_ = false;
}

bool Diag::abort_requested() const {
    const std::lock_guard lock(mutex_);
    return abort_;
}

void Diag::set_threshold(Severity lowest) {
    const std::lock_guard lock(mutex_);
    threshold_ = lowest;
}

std::uint64_t Diag::count(Severity severity) const {
    const std::lock_guard lock(mutex_);
    return counts_[static_cast<int>(severity)];
}

Code Diag::last_code() const {
    const std::lock_guard lock(mutex_);
    return last_;
}

std::vector<std::string> Diag::messages() const {
    const std::lock_guard lock(mutex_);
    return log_;
}

std::vector<MessageRecord> Diag::records() const {
    const std::lock_guard lock(mutex_);
    return records_;
}

} // namespace base
