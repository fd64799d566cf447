// SPDX-License-Identifier: Apache-2.0
// Strings the stages together; the only place that knows all of them.
#include "slc/compiler.h"

#include "slc/check.h"
#include "slc/ir_text.h"
#include "slc/lex.h"
#include "slc/lower.h"
#include "slc/parse.h"
#include "slc/preprocess.h"

namespace slc {

namespace {

// One compilation: the sources and messages all stages share.
struct Session {
    Session(base::Diag& diag, const std::string& name, const CompileOptions& options)
        : messages(diag, sources, options.on_message), externals(options.find_functions) {
        sources.add(name);
    }
    Sources sources;
    Messages messages;
    Externals externals;
};

std::optional<std::string> read_or_complain(const std::string& path, Messages& messages) {
    auto text = read_source(path);
    if (!text) {
        messages.system_error("cannot read " + quoted(path), base::Code::NoFile);
    }
    return text;
}

// Preprocessed text to a checked tree; nullptr when there is nothing to go on with.
std::optional<std::string> preprocessed(std::string_view raw, const std::string& name,
                                        const CompileOptions& options, Session& session) {
    std::string text = normalise_text(raw);
    session.sources.set_text(0, text);
    return options.is_preprocessed ? std::move(text)
                                   : preprocess(text, name, options, session.messages);
}

std::unique_ptr<ast::File> checked_tree(const std::string& text, Session& session) {
    TokenList list = lex(text, session.messages);
    map_columns(list.tokens, session.sources);
    auto file = parse(list.tokens, session.messages);
    // Names and types of a file with syntax errors are still worth checking, but not after the
    // limit.
    if (!session.messages.too_many()) {
        check(*file, session.externals, session.messages);
    }
    return file;
}

Unit lowered(const ast::File& file, const CompileOptions& options, bool with_passes,
             Session& session) {
    Unit unit;
    for (const ast::Definition& d : file.definitions) {
        if (d.shader == nullptr || session.messages.num_errors() != 0) {
            continue;
        }
        auto program = lower(*d.shader, session.messages);
        if (!program) {
            continue;
        }
        program->files = session.sources.names();
        if (with_passes) {
            run_passes(*program, options, &session.messages);
        }
        unit.programs.push_back(std::move(*program));
    }
    return unit;
}

Unit build(std::string_view raw, const std::string& name, const CompileOptions& options,
           bool with_passes, Session& session) {
    Unit unit;
    if (const auto text = preprocessed(raw, name, options, session)) {
        const auto file = checked_tree(*text, session);
        unit = lowered(*file, options, with_passes, session);
    }
    unit.num_errors = session.messages.num_errors();
    return unit;
}

Unit build_file(const std::string& path, const CompileOptions& options, bool with_passes,
                base::Diag& diag) {
    Session session(diag, path, options);
    const auto raw = read_or_complain(path, session.messages);
    if (!raw) {
        Unit unit;
        unit.num_errors = session.messages.num_errors();
        return unit;
    }
    return build(*raw, path, options, with_passes, session);
}

} // namespace

Unit compile_file(const std::string& path, const CompileOptions& options, base::Diag& diag) {
    return build_file(path, options, true, diag);
}

Unit compile_text(std::string_view text, const std::string& name, const CompileOptions& options,
                  base::Diag& diag) {
    Session session(diag, name, options);
    return build(text, name, options, true, session);
}

Unit front_end_file(const std::string& path, const CompileOptions& options, base::Diag& diag) {
    return build_file(path, options, false, diag);
}

Unit front_end_text(std::string_view text, const std::string& name, const CompileOptions& options,
                    base::Diag& diag) {
    Session session(diag, name, options);
    return build(text, name, options, false, session);
}

std::optional<std::string> preprocess_file(const std::string& path, const CompileOptions& options,
                                           base::Diag& diag) {
    Session session(diag, path, options);
    const auto raw = read_or_complain(path, session.messages);
    return raw ? preprocessed(*raw, path, options, session) : std::nullopt;
}

std::optional<DumpKind> dump_kind(std::string_view name) {
    constexpr std::string_view names[] = {"tokens", "ast", "ir", "points", "facts"};
    for (std::size_t i = 0; i < std::size(names); ++i) {
        if (names[i] == name) {
            return static_cast<DumpKind>(i);
        }
    }
    return std::nullopt;
}

std::optional<std::string> dump_file(const std::string& path, DumpKind kind,
                                     const CompileOptions& options, base::Diag& diag) {
    Session session(diag, path, options);
    const auto raw = read_or_complain(path, session.messages);
    const auto text = raw ? preprocessed(*raw, path, options, session) : std::nullopt;
    if (!text) {
        return std::nullopt;
    }
    if (kind == DumpKind::Tokens) {
        TokenList list = lex(*text, session.messages);
        map_columns(list.tokens, session.sources);
        return dump_tokens(list.tokens, session.sources);
    }
    const auto file = checked_tree(*text, session);
    if (kind == DumpKind::Ast) {
        return ast::dump(*file);
    }
    const Unit unit = lowered(*file, options, true, session);
    std::string out;
    for (const Program& program : unit.programs) {
        if (kind == DumpKind::Ir) {
            out += print_ir(program);
            continue;
        }
        Program resolved = program;
        resolve_area_operators(resolved, options);
        out +=
            kind == DumpKind::Points ? print_ir(resolved) : facts_text(resolved, analyse(resolved));
    }
    return session.messages.num_errors() == 0 ? std::optional(out) : std::nullopt;
}

} // namespace slc
