// SPDX-License-Identifier: Apache-2.0
// DSOs with functions for shaders (runtime/abi/sl_shadeop.h), and those of the older form
// NAME_shadeops. In: directories the user named; nothing else is ever opened. Out: functions by
// name, with their signatures, for the compiler; calls for the engine. Safe from any thread.
#pragma once

#include "runtime/abi/sl_abi.h"

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace base {

struct ShadeopArgument {
    sl_type type = SL_TYPE_float;
    bool is_output = false;
};

// One overload of a function.
class Shadeop {
public:
    [[nodiscard]] const std::string& name() const { return name_; }
    // "f(p,F)", as in sl_builtins.def.
    [[nodiscard]] const std::string& signature() const { return signature_; }
    [[nodiscard]] const std::string& file() const { return file_; }
    [[nodiscard]] sl_type result() const { return result_; } // SL_TYPE_void: none
    [[nodiscard]] std::span<const ShadeopArgument> arguments() const { return arguments_; }

    // Values in the order of the signature, the result (if any) first: floats, or one pointer to a
    // text.
    void call(std::span<void* const> values) const;

private:
    friend class ShadeopLibrary;
    enum class Form { Table, Classic };
    // False if the text is no signature.
    bool parse(std::string_view text);
    bool parse_classic(std::string_view text);
    [[nodiscard]] std::string signature_text() const;
    void start() const;

    std::string name_, signature_, file_;
    sl_type result_ = SL_TYPE_void;
    std::vector<ShadeopArgument> arguments_;
    Form form_ = Form::Table;
    void* function_ = nullptr;
    void* init_ = nullptr;
    void* cleanup_ = nullptr;
    struct Run;
    std::shared_ptr<Run> run_; // what init returned
};

class ShadeopLibrary {
public:
    // Every *.so of these directories, in this order, by name within one. They are opened when a
    // function is first looked for.
    explicit ShadeopLibrary(std::vector<std::string> directories);
    ~ShadeopLibrary();
    ShadeopLibrary(const ShadeopLibrary&) = delete;
    ShadeopLibrary& operator=(const ShadeopLibrary&) = delete;

    [[nodiscard]] bool empty() const { return directories_.empty(); }
    // Overloads in the order of the tables; of several DSOs with the name the first counts.
    [[nodiscard]] std::vector<const Shadeop*> find(std::string_view name);
    // nullptr: no such overload.
    [[nodiscard]] const Shadeop* find(std::string_view name, std::string_view signature);
    // What could not be opened or understood, one message each, since the last call. Opens the
    // DSOs.
    [[nodiscard]] std::vector<std::string> take_problems();
    // Changes when a DSO, and so maybe a signature, does: files with sizes and times.
    [[nodiscard]] std::string identity() const;

private:
    struct Impl;
    std::vector<std::string> directories_;
    std::unique_ptr<Impl> impl_;
};

} // namespace base
