// SPDX-License-Identifier: Apache-2.0
// The entry to ribtools: RIB enters (text, binary, either gzipped), finished scenes leave through
// Backend::render.
//
// One Reader is one rendering context (ri.md 1.2): options, declarations, lights and archives
// persist from one read_* call to the next. Mistakes in the input are reported to Diag with their
// place and reading goes on; only what the environment refuses (a file that cannot be opened, no
// memory) ends a read early, see ReadStatus.
#pragma once

#include "ribtools/backend.h"
#include "ribtools/rib_lex.h"
#include "ribtools/scene.h"
#include "runtime/base/diag.h"

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace rib {

enum class ReadStatus : std::uint8_t {
    Ok,          // read to the end; Diag knows whether the input had errors
    Stopped,     // the backend returned false, or ErrorHandler "abort" met an error
    Environment, // file not found or unreadable, memory exhausted: reported, exit code 3
};

struct Config {
    // Built-in search paths: what "@" stands for, and the first value of each path. Keys: "shader",
    // "texture", "archive", "procedural", "display". Not there: the current directory.
    std::map<std::string, std::vector<std::string>> default_paths;
    // RunProgram, DynamicLoad and System may start programs. Nothing here does yet; without consent
    // it is said why.
    bool allow_programs = false;
    // Options before the first request: switches that the RIB overrides (-res, -samples).
    Options defaults;
    // Called at WorldBegin on the options of that world: switches that override the RIB (-crop,
    // -o). May be empty.
    std::function<void(Options&)> override_options;
    // Told of every parameter of Option, as "group:name", when it is set. May be empty.
    std::function<void(std::string_view, const Param&)> on_option;
    // Says whether a world is wanted (-frames). If not, its primitives are neither kept nor
    // rendered, its archives not read, and textures of its frame not made. May be empty.
    std::function<bool(const Options&)> wants_world;
    // True once the user wants to stop: asked between requests and while input is awaited. May be
    // null.
    bool (*interrupted)() = nullptr;
    // Receives comments. May be empty.
    Lexer::CommentHandler on_comment;
};

class Reader {
public:
    Reader(Backend& backend, base::Diag& diag, Config config);
    ~Reader();
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;

    // "-" is standard input. Blocks still open at the end of the file are closed with a message; an
    // unfinished world is not rendered (ri.md 16.20).
    ReadStatus read_file(const std::string& path);
    ReadStatus read_stdin();
    // RIB from memory: -option, .rendribrc, tests. `name` stands in messages.
    ReadStatus read_text(std::string_view text, std::string_view name);

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace rib
