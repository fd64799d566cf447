// SPDX-License-Identifier: Apache-2.0
// Messages about user input and the environment: file:line:col: severity: text.
// One Diag per run, passed down; it is the only writer to standard error and is safe from any
// thread. Severities and codes are those of the RenderMan Interface (ri.md, section 13).
#pragma once

#include <cstdint>
#include <cstdio>
#include <mutex>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace base {

enum class Severity : std::uint8_t { Info, Warning, Error, Severe };

// RI error codes; values are those of ri.h.
enum class Code : std::uint8_t {
#define DIAG_CODE(name, value, ri_name) name = value,
#include "runtime/base/diag_codes.def"
#undef DIAG_CODE
};

// A place in user input. file_id indexes Diag's table of file names; 0 means "no place".
struct SourcePos {
    std::uint32_t file_id = 0;
    std::uint32_t line = 0; // from 1
    std::uint32_t col = 0;  // from 1, bytes
    friend bool operator==(const SourcePos&, const SourcePos&) = default;
};

// What to do with a message, RiErrorHandler.
enum class ErrorHandler : std::uint8_t { Ignore, Print, Abort };

// Messages of one text, for reports. How often it occurred counts repeats that report_once() kept
// quiet.
struct MessageRecord {
    Severity severity = Severity::Info;
    Code code = Code::None;
    std::string text;
    std::uint64_t count = 0;
    std::vector<std::string> places; // "file:line:col" of the first few
};

class Diag {
public:
    explicit Diag(std::FILE* out = stderr) : out_(out) {}
    Diag(const Diag&) = delete;
    Diag& operator=(const Diag&) = delete;

    // Registers a file name; the same name gets the same id.
    std::uint32_t file_id(std::string_view name);
    [[nodiscard]] std::string file_name(std::uint32_t id) const;

    void report(Severity severity, Code code, SourcePos pos, std::string_view text);
    // Only the first report with this key is printed and counted (unknown option, missing shader
    // ...).
    void report_once(std::string_view key, Severity severity, Code code, SourcePos pos,
                     std::string_view text);

    void set_handler(ErrorHandler handler);
    // True after an error arrived while the handler is Abort: the caller winds the run down.
    [[nodiscard]] bool abort_requested() const;
    // Messages below this severity are dropped (-silent), but still counted.
    void set_threshold(Severity lowest);

    [[nodiscard]] std::uint64_t count(Severity severity) const;
    [[nodiscard]] bool had_errors() const {
        return count(Severity::Error) + count(Severity::Severe) > 0;
    }
    [[nodiscard]] Code last_code() const; // RiLastError
    // Everything printed so far, for reports (--stats, HTML) and tests.
    [[nodiscard]] std::vector<std::string> messages() const;
    // Every message, printed or not, gathered by text in the order of their first occurrence.
    [[nodiscard]] std::vector<MessageRecord> records() const;

private:
    // With the lock held.
    std::size_t record(Severity severity, Code code, const std::string& place,
                       std::string_view text);
    void say(Severity severity, Code code, const std::string& place, std::string_view text);

    mutable std::mutex mutex_;
    std::FILE* out_;
    ErrorHandler handler_ = ErrorHandler::Print;
    Severity threshold_ = Severity::Info;
    bool abort_ = false;
    Code last_ = Code::None;
    std::uint64_t counts_[4] = {};
    std::vector<std::string> files_;
    std::vector<std::string> log_;
    std::vector<MessageRecord> records_;
    std::unordered_map<std::string, std::size_t> record_of_text_;
    std::unordered_map<std::string, std::size_t> seen_; // key of report_once(): its record
};

[[nodiscard]] std::string_view severity_name(Severity severity);
[[nodiscard]] std::string_view code_name(Code code); // RIE_RANGE

} // namespace base
