// SPDX-License-Identifier: Apache-2.0
#include "ribtools/rib_convert.h"

#include "ribtools/rib_parse.h"
#include "ribtools/search_path.h"
#include "ribtools/spelling.h"
#include "runtime/base/search_path.h"

#include <algorithm>
#include <new>
#include <set>
#include <tuple>
#include <vector>

namespace rib {

namespace {

constexpr std::size_t max_archive_depth = 100;
constexpr std::uint64_t max_archive_reads = 1'000'000;

struct HeldComment {
    std::string kind, text;
    base::SourcePos pos;
    bool trailing;
};

bool precedes(base::SourcePos a, base::SourcePos b) {
    return std::tie(a.line, a.col) < std::tie(b.line, b.col);
}

} // namespace

class Converter::Impl {
public:
    Impl(Writer& writer, base::Diag& diag, ConvertOptions options)
        : writer_(writer), diag_(diag), options_(options) {}

    ReadStatus read_path(const std::string& path) {
        OpenResult opened = open_file(path);
        if (!opened.source) {
            diag_.report(base::Severity::Severe, base::Code::NoFile, {},
                         "cannot read " + printable(path) + ": " + opened.error);
            return ReadStatus::Environment;
        }
        return read_top(std::move(opened.source), path, path);
    }

    ReadStatus read_top(std::unique_ptr<ByteSource> source, std::string_view name,
                        const std::string& path) {
        try {
            read_stream(std::move(source), name, path);
        } catch (const std::bad_alloc&) {
            diag_.report(base::Severity::Severe, base::Code::NoMem, {}, "out of memory");
            return ReadStatus::Environment;
        }
        diag_.tell_repeated();
        return failed_ ? ReadStatus::Environment : ReadStatus::Ok;
    }

private:
    void read_stream(std::unique_ptr<ByteSource> source, std::string_view name,
                     const std::string& path) {
        std::vector<HeldComment> comments;
        const Lexer::CommentHandler hold = [&](const Comment& c) {
            comments.push_back({std::string(c.kind), std::string(c.text), c.pos, c.trailing});
        };
        Lexer lexer(std::move(source), {diag_.file_id(name), 1, 1}, &hold);
        Parser parser(lexer, diag_, dictionary_, colors_, ParseMode::Keep);
        open_paths_.push_back(path);
        Request request;
        while (parser.next(request)) {
            const auto behind =
                std::find_if(comments.begin(), comments.end(),
                             [&](const HeldComment& c) { return !precedes(c.pos, request.pos); });
            record(comments.begin(), behind);
            take(request);
            record(behind, comments.end());
            comments.clear();
        }
        record(comments.begin(), comments.end());
        open_paths_.pop_back();
        if (!lexer.read_error().empty()) {
            report_broken(lexer);
        }
    }

    void record(std::vector<HeldComment>::const_iterator begin,
                std::vector<HeldComment>::const_iterator end) {
        for (; begin != end; ++begin) {
            writer_.record(begin->kind, begin->text, begin->trailing);
        }
    }

    void report_broken(const Lexer& lexer) {
        if (lexer.is_damaged()) {
            diag_.report(base::Severity::Error, base::Code::BadFile, lexer.token().pos,
                         lexer.read_error() + "; the rest is not read");
        } else {
            diag_.report(base::Severity::Severe, base::Code::System, lexer.token().pos,
                         "reading failed: " + lexer.read_error());
            failed_ = true;
        }
    }

    // Only what the reading of later requests depends on is looked at.
    void take(const Request& request) {
        switch (request.id) {
        case RequestId::Declare:
            declare(request.string(0), request.string(1));
            break;
        case RequestId::ArchiveBegin:
            inline_archives_.insert(request.string(0));
            break;
        case RequestId::Option:
            note_search_path(request);
            break;
        case RequestId::ReadArchive:
            if (options_.expand && expand(request)) {
                return;
            }
            break;
        default:
            break;
        }
        writer_.request(request);
    }

    void declare(const std::string& name, const std::string& text) {
        const Declaration d = parse_declaration(text);
        if (d.error.empty()) {
            dictionary_.set(name, {d.decl, false, false});
        } else {
            dictionary_.remove(name); // values of this name are kept by their looks
        }
    }

    void note_search_path(const Request& request) {
        if (request.string(0) != "searchpath") {
            return;
        }
        for (const Param& p : request.params.params) {
            const std::string name =
                is_inline_declaration(p.name) ? parse_inline_declaration(p.name).name : p.name;
            if (name != "archive" && name != "include" && name != "resource") {
                continue;
            }
            std::vector<std::string> directories;
            for (const std::string& value : p.strings) {
                for (std::string& d : base::expand_search_path(value, archive_path_, {})) {
                    directories.push_back(std::move(d));
                }
            }
            archive_path_ = std::move(directories);
        }
    }

    // False: the request shall stay.
    bool expand(const Request& request) {
        const std::string& name = request.string(0);
        if (inline_archives_.contains(name)) {
            return false;
        }
        const std::string head = "ReadArchive: " + printable(name);
        if (open_paths_.size() > max_archive_depth || ++num_archive_reads_ > max_archive_reads) {
            diag_.report_once("archive-limit", base::Severity::Error, base::Code::Limit,
                              request.pos, head + ": too many archives in archives; kept");
            return false;
        }
        const std::vector<std::string> readers(open_paths_.rbegin(), open_paths_.rend());
        for (const std::string& path : archive_candidates(name, archive_path_, readers)) {
            OpenResult opened = open_archive(path);
            if (!opened.source) {
                continue;
            }
            if (std::find(readers.begin(), readers.end(), path) != readers.end()) {
                diag_.report(base::Severity::Error, base::Code::IllState, request.pos,
                             head + " reads itself; kept");
                return false;
            }
            read_stream(std::move(opened.source), path, path);
            return true;
        }
        diag_.report(base::Severity::Error, base::Code::NoFile, request.pos,
                     head + ": not found; kept");
        return false;
    }

    Writer& writer_;
    base::Diag& diag_;
    const ConvertOptions options_;
    Dictionary dictionary_;
    const ColorModel colors_;
    std::vector<std::string> archive_path_;
    std::set<std::string> inline_archives_;
    std::vector<std::string> open_paths_; // of the streams being read, innermost last
    std::uint64_t num_archive_reads_ = 0;
    bool failed_ = false; // the environment refused something
};

Converter::Converter(Writer& writer, base::Diag& diag, ConvertOptions options)
    : impl_(std::make_unique<Impl>(writer, diag, options)) {}

Converter::~Converter() = default;

ReadStatus Converter::convert_file(const std::string& path) {
    return path == "-" ? impl_->read_top(open_stdin(), "stdin", "") : impl_->read_path(path);
}

ReadStatus Converter::convert_text(std::string_view text, std::string_view name) {
    return convert(open_memory(std::make_shared<const std::string>(text)), name);
}

ReadStatus Converter::convert(std::unique_ptr<ByteSource> source, std::string_view name) {
    return impl_->read_top(std::move(source), name, "");
}

} // namespace rib
