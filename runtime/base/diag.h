// SPDX-License-Identifier: Apache-2.0
// Messages about user input and the environment: file:line:col: severity: text, for binary input
// file:byte offset: severity: text.
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

// A place in user input. file_id indexes Diag's table of file names; 0 means "no place". In binary
// data, which has no lines, it is a byte offset, kept in the bits of line and column.
struct SourcePos {
    std::uint32_t file_id = 0;
    std::uint32_t line = 0; // from 1
    std::uint32_t col = 0;  // from 1, bytes

    static constexpr std::uint32_t byte_mark = 1u << 31;
    [[nodiscard]] static SourcePos at_byte(std::uint32_t file_id, std::uint64_t offset) {
        return {file_id, byte_mark | static_cast<std::uint32_t>(offset >> 32),
                static_cast<std::uint32_t>(offset)};
    }
    [[nodiscard]] bool is_byte() const { return (line & byte_mark) != 0; }
    // From 0, as hex dumps count.
    [[nodiscard]] std::uint64_t byte() const {
        return static_cast<std::uint64_t>(line & ~byte_mark) << 32 | col;
    }
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
    // For work done ahead of its turn: messages are kept until deliver() instead of being printed.
    enum class Deferred : std::uint8_t { Yes };
    explicit Diag(Deferred) : out_(nullptr), deferred_(true) {}
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

    // The first few reports with this key are printed, the others counted; true: printed. Keys are
    // for kinds of mistakes that a program makes throughout a file, see kind_of().
    bool report_few(std::string_view key, std::uint64_t most, Severity severity, Code code,
                    SourcePos pos, std::string_view text);
    // Says how many more of each kind there were, once.
    void tell_repeated();
    // Reports everything that was kept to another Diag, as if it happened now, and forgets it.
    void deliver(Diag& to);
    // The same place, for messages to this Diag.
    [[nodiscard]] SourcePos place_from(const Diag& other, SourcePos pos) {
        pos.file_id = pos.file_id == 0 ? 0 : file_id(other.file_name(pos.file_id));
        return pos;
    }

    void set_handler(ErrorHandler handler);
    // True after an error arrived while the handler is Abort: the caller winds the run down.
    [[nodiscard]] bool abort_requested() const;
    void clear_abort(); // the next stream is another matter
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
    void note(Severity severity, Code code);
    void print(Severity severity, const std::string& place, std::string_view text);

    struct Repeated {
        Severity severity;
        std::string last_place, text; // of the last that was kept quiet; of the first
        std::uint64_t num_said, num_quiet;
    };

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
    std::vector<Repeated> repeated_;
    std::unordered_map<std::string, std::size_t> repeated_index_; // by key of report_few()
    std::unordered_map<std::string, std::size_t> seen_; // key of report_once(): its record
    struct Kept {
        std::string key, file, text; // key "": not a report_once
        SourcePos pos;
        Severity severity;
        Code code;
    };
    bool deferred_ = false;
    std::vector<Kept> kept_; // if deferred
    void keep(std::string_view key, Severity severity, Code code, SourcePos pos,
              std::string_view text);
};

// "line 12" or "byte 345", for messages that refer to another place.
[[nodiscard]] std::string place_name(SourcePos pos);

// How many messages of one kind are worth printing.
constexpr std::uint64_t max_alike = 10;
// A message without its numbers: what kind of mistake it tells of.
[[nodiscard]] std::string kind_of(std::string_view text);

[[nodiscard]] std::string_view severity_name(Severity severity);
[[nodiscard]] std::string_view code_name(Code code); // RIE_RANGE

} // namespace base
