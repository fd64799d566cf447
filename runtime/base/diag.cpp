// SPDX-License-Identifier: Apache-2.0
#include "runtime/base/diag.h"

#include <algorithm>

namespace base {

namespace {
// Kept for reports; a hostile file must not grow it without bound.
constexpr std::size_t max_log = 10'000;
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
    const std::string file = file_name(pos.file_id);
    const std::lock_guard lock(mutex_);
    std::string line;
    if (!file.empty()) {
        line = file + ":";
        if (pos.line > 0) {
            line += std::to_string(pos.line) + ":";
        }
        if (pos.col > 0) {
            line += std::to_string(pos.col) + ":";
        }
        line += " ";
    } else {
        line = "perigee: ";
    }
    line += severity_name(severity);
    line += ": ";
    line += text;
    ++counts_[static_cast<int>(severity)];
    if (code != Code::None) {
        last_ = code;
    }
    if (handler_ == ErrorHandler::Abort && severity >= Severity::Error) {
        abort_ = true;
    }
    if (handler_ == ErrorHandler::Ignore || severity < threshold_) {
        return;
    }
    std::fprintf(out_, "%s\n", line.c_str());
    if (log_.size() < max_log) {
        log_.push_back(std::move(line));
    }
}

void Diag::report_once(std::string_view key, Severity severity, Code code, SourcePos pos,
                       std::string_view text) {
    {
        const std::lock_guard lock(mutex_);
        if (!seen_.emplace(key).second) {
            return;
        }
    }
    report(severity, code, pos, text);
}

void Diag::set_handler(ErrorHandler handler) {
    const std::lock_guard lock(mutex_);
    handler_ = handler;
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

} // namespace base
