// SPDX-License-Identifier: Apache-2.0
#include "slc/driver.h"

#include "runtime/base/file.h"
#include "runtime/base/sha256.h"
#include "sl_fingerprint.h"
#include "slc/emit_c.h"
#include "slc/ir_text.h"

#include <filesystem>
#include <unistd.h>

namespace slc {

namespace {

std::string base_name(const std::string& path) {
    return std::filesystem::path(path).filename().string();
}

// Objects name their files without directories, so that the same source gives the same bytes
// anywhere.
Program with_plain_files(const Program& program) {
    Program plain = program;
    for (std::string& file : plain.files) {
        file = base_name(file);
    }
    return plain;
}

std::vector<int> widths(const ObjectOptions& options) {
    return options.native_only ? std::vector<int>{native_lanes()} : std::vector<int>{8, 4};
}

EmitOptions emit_options(const Program& plain, int lanes, const ObjectOptions& options) {
    EmitOptions emit;
    emit.lanes = lanes;
    emit.variants = widths(options);
    emit.source = plain.files.empty() ? plain.name : plain.files.front();
    emit.ir_text = print_ir(plain);
    return emit;
}

} // namespace

std::string c_text(const Program& program, int lanes, const ObjectOptions& options) {
    const Program plain = with_plain_files(program);
    return emit_c(plain, analyse(plain), emit_options(plain, lanes, options));
}

Outcome build_object(const Program& program, const ObjectOptions& options,
                     const std::string& slo_path, base::Diag& diag) {
    // An object from before must not pass for the result of this compilation.
    ::unlink(slo_path.c_str());
    const auto tools = find_toolchain(options.front.preprocessor, diag);
    if (!tools) {
        return Outcome::BadEnvironment;
    }
    const Program plain = with_plain_files(program);
    const Facts facts = analyse(plain);
    std::vector<VariantText> variants;
    for (const int lanes : widths(options)) {
        variants.push_back({lanes, emit_c(plain, facts, emit_options(plain, lanes, options))});
    }
    return build_shared_object(*tools, variants, options.flags, slo_path, diag)
               ? Outcome::Done
               : Outcome::BadEnvironment;
}

bool compile_to_object(const std::string& sl_path, const std::string& slo_path,
                       const ObjectOptions& options, base::Diag& diag) {
    ::unlink(slo_path.c_str());
    const Unit unit = compile_file(sl_path, options.front, diag);
    if (!unit.ok()) {
        return false;
    }
    if (unit.programs.empty()) {
        diag.report(base::Severity::Error, base::Code::NoShader, {},
                    sl_path + " defines no shader");
        return false;
    }
    const std::string stem = std::filesystem::path(sl_path).stem().string();
    const Program* chosen = &unit.programs.front();
    for (const Program& program : unit.programs) {
        if (program.name == stem) {
            chosen = &program;
        }
    }
    if (unit.programs.size() > 1 && chosen->name != stem) {
        diag.report(base::Severity::Warning, base::Code::NoShader, {},
                    sl_path + " holds several shaders, none named " + stem + "; " + chosen->name +
                        " is used");
    }
    return build_object(*chosen, options, slo_path, diag) == Outcome::Done;
}

std::optional<std::string> object_key(const std::string& sl_path, const ObjectOptions& options,
                                      base::Diag& diag) {
    const auto tools = find_toolchain(options.front.preprocessor, diag);
    if (!tools) {
        return std::nullopt;
    }
    auto text = base::read_file(sl_path);
    if (!text) {
        diag.report(base::Severity::Error, base::Code::NoFile, {}, "cannot read " + sl_path);
        return std::nullopt;
    }
    // "%:" and "??=" also spell the sign that starts a directive.
    const bool may_include = text->find("include") != std::string::npos ||
                             text->find("%:") != std::string::npos ||
                             text->find("??") != std::string::npos;
    if (may_include) {
        text = preprocess_file(sl_path, options.front, diag);
        if (!text) {
            return std::nullopt;
        }
    }
    base::Sha256 hash;
    hash.add_field(*text).add_field(base_name(sl_path));
    hash.add_field(SL_ABI_FINGERPRINT).add_field(toolchain_identity(*tools, options.flags));
    for (const int lanes : widths(options)) {
        hash.add_field(std::to_string(lanes));
    }
    for (const std::string& define : options.front.defines) {
        hash.add_field("-D" + define);
    }
    hash.add_field(options.front.optimise ? "optimised" : "plain");
    return hash.hex();
}

} // namespace slc
