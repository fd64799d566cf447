// SPDX-License-Identifier: Apache-2.0
// Reader: streams, archives and conditionals around one State.
#include "ribtools/reader.h"

#include "ribtools/archives.h"
#include "ribtools/conditional.h"
#include "ribtools/rib_parse.h"
#include "ribtools/rib_source.h"
#include "ribtools/search_path.h"
#include "ribtools/spelling.h"
#include "ribtools/state.h"

#include <algorithm>
#include <new>

namespace rib {

namespace {

// Archives in archives. Each level costs a block of buffer and some machine stack.
constexpr std::size_t max_archive_depth = 100;
// Archives that read archives several times over multiply; this many end any such flood.
constexpr std::uint64_t max_archive_reads = 4'000'000;

} // namespace

class Reader::Impl final : public StreamHost {
public:
    Impl(Backend& backend, base::Diag& diag, Config config)
        : diag_(diag), config_(std::move(config)), state_(backend, diag, config_, *this) {}

    ReadStatus read_path(const std::string& path) {
        OpenResult opened = open_file(path, config_.interrupted);
        if (!opened.source) {
            diag_.report(base::Severity::Error, base::Code::NoFile, {},
                         "cannot read " + printable(path) + ": " + opened.error);
            return ReadStatus::Environment;
        }
        return read_top(std::move(opened.source), path, path);
    }

    ReadStatus read_stdin() { return read_top(open_stdin(config_.interrupted), "stdin", ""); }

    // A stream of its own: blocks opened in it end with it.
    ReadStatus read_top(std::unique_ptr<ByteSource> source, std::string_view name,
                        const std::string& path) {
        bool stopped = false;
        try {
            state_.restart();
            const std::size_t depth = state_.depth();
            const base::SourcePos start{diag_.file_id(name), 1, 1};
            Lexer lexer(std::move(source), start, &config_.on_comment);
            read_stream(lexer, path);
            stopped = is_stopped();
            state_.close_blocks(lexer.token().pos, depth, !stopped && lexer.read_error().empty());
        } catch (const std::bad_alloc&) {
            diag_.report(base::Severity::Severe, base::Code::NoMem, {}, "out of memory");
            return ReadStatus::Environment;
        }
        diag_.tell_repeated();
        return failed_ ? ReadStatus::Environment : stopped ? ReadStatus::Stopped : ReadStatus::Ok;
    }

    // --- StreamHost ---

    void read_archive(const std::string& name, base::SourcePos pos) override {
        if (streams_.size() > max_archive_depth || ++num_archive_reads_ > max_archive_reads) {
            diag_.report_once("archive-limit", base::Severity::Error, base::Code::Limit, pos,
                              "ReadArchive " + printable(name) +
                                  ": too many archives in archives; skipped");
            return;
        }
        if (const InlineArchive* archive = archives_.find(name)) {
            read_inline(*archive, pos);
        } else {
            read_archive_file(name, pos);
        }
    }

    void begin_archive(const std::string& name, base::SourcePos pos) override {
        InlineArchive archive;
        Recording recording;
        if (streams_.back().parser->record_archive(pos, recording)) {
            archive.name = name;
            archive.recording = std::make_shared<const Recording>(std::move(recording));
            archives_.add(std::move(archive));
        }
    }

    void conditional(const Request& request) override {
        Conditions& conditions = streams_.back().conditions;
        conditions.step(
            request,
            [&](const std::string& text) {
                return evaluate_condition(text, state_.options(), state_.attributes(), diag_,
                                          request.pos);
            },
            diag_);
    }

    void forget_archives(std::size_t keep) override { archives_.keep(keep); }
    std::size_t num_archives() const override { return archives_.size(); }

private:
    [[nodiscard]] bool is_stopped() const {
        return state_.stopped() || (config_.interrupted != nullptr && config_.interrupted());
    }

    struct Stream {
        Parser* parser;
        std::string
            path; // "" for memory: where relative archive names start, and what may not read itself
        Conditions conditions;
    };

    // Reads to the end, which is then the lexer's token.
    void read_stream(Lexer& lexer, const std::string& path) {
        Parser parser(lexer, diag_, state_.dictionary(), state_.colors());
        streams_.push_back({&parser, path, {}});
        Request request;
        while (!is_stopped() && parser.next(request)) {
            const bool is_conditional =
                request.id == RequestId::IfBegin || request.id == RequestId::ElseIf ||
                request.id == RequestId::Else || request.id == RequestId::IfEnd;
            if (streams_.back().conditions.active() || is_conditional) {
                state_.execute(request);
            } else if (request.id == RequestId::ArchiveBegin) {
                Recording ignored;
                (void)parser.record_archive(request.pos, ignored);
            }
        }
        if (lexer.read_error().empty()) {
            streams_.back().conditions.finish(lexer.token().pos, diag_);
        } else {
            report_broken(lexer);
        }
        streams_.pop_back();
    }

    // The stream broke off. What that leaves open needs no messages of its own.
    void report_broken(const Lexer& lexer) {
        if (lexer.is_damaged()) {
            diag_.report(base::Severity::Error, base::Code::BadFile, lexer.token().pos,
                         lexer.read_error() +
                             "; the rest is not read, an unfinished world not rendered");
        } else {
            diag_.report(base::Severity::Severe, base::Code::System, lexer.token().pos,
                         "reading failed: " + lexer.read_error());
            failed_ = true;
        }
    }

    bool is_open(const std::string& path) const {
        return std::any_of(streams_.begin(), streams_.end(),
                           [&](const Stream& s) { return s.path == path; });
    }

    void report_circular(const std::string& name, base::SourcePos pos) {
        diag_.report(base::Severity::Error, base::Code::IllState, pos,
                     "ReadArchive: " + printable(name) + " reads itself; skipped");
    }

    void read_inline(const InlineArchive& archive, base::SourcePos pos) {
        const std::string mark = "archive " + archive.name;
        if (is_open(mark)) {
            report_circular(archive.name, pos);
            return;
        }
        Lexer lexer(archive.recording, &config_.on_comment);
        read_stream(lexer, mark);
    }

    void read_archive_file(const std::string& name, base::SourcePos pos) {
        const std::vector<std::string> candidates = candidates_for(name);
        std::string why = "No such file or directory";
        for (const std::string& path : candidates) {
            OpenResult opened = open_archive(path);
            if (!opened.source) {
                continue;
            }
            if (is_open(path)) {
                report_circular(name, pos);
                return;
            }
            Lexer lexer(std::move(opened.source), {diag_.file_id(path), 1, 1}, &config_.on_comment);
            read_stream(lexer, path);
            return;
        }
        diag_.report_few("no archive " + name, 1, base::Severity::Error, base::Code::NoFile, pos,
                         "ReadArchive: " + printable(name) + ": not found (looked in " +
                             std::to_string(candidates.size()) + " places); skipped");
    }

    std::vector<std::string> candidates_for(const std::string& name) const {
        const std::vector<std::string> directories =
            search_directories(state_.options(), "archive");
        std::vector<std::string> readers;
        for (auto it = streams_.rbegin(); it != streams_.rend(); ++it) {
            if (!it->path.starts_with("archive ")) {
                readers.push_back(it->path);
            }
        }
        return archive_candidates(name, directories, readers);
    }

    base::Diag& diag_;
    Config config_;
    Archives archives_;
    std::vector<Stream> streams_;
    std::uint64_t num_archive_reads_ = 0;
    bool failed_ = false; // the environment refused something
    State state_;
};

Reader::Reader(Backend& backend, base::Diag& diag, Config config)
    : impl_(std::make_unique<Impl>(backend, diag, std::move(config))) {}

Reader::~Reader() = default;

ReadStatus Reader::read_file(const std::string& path) {
    return path == "-" ? read_stdin() : impl_->read_path(path);
}

ReadStatus Reader::read_stdin() {
    return impl_->read_stdin();
}

ReadStatus Reader::read_text(std::string_view text, std::string_view name) {
    return impl_->read_top(open_memory(std::make_shared<const std::string>(text)), name, "");
}

} // namespace rib
