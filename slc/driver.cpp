// SPDX-License-Identifier: Apache-2.0
#include "slc/driver.h"

#include "runtime/base/file.h"
#include "runtime/base/sha256.h"
#include "sl_fingerprint.h"
#include "slc/emit_c.h"
#include "slc/ir_text.h"
#include "slc/key_index.h"

#include <algorithm>
#include <bit>
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

Program resolved(const Program& program, const CompileOptions& options) {
    Program ready = program;
    resolve_area_operators(ready, options);
    return ready;
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
    emit.profile = options.profile;
    emit.checked = options.checked;
    return emit;
}

// Everything but the source that decides the bytes of an object.
std::string settings_text(const Toolchain& tools, const ObjectOptions& options) {
    std::string text = SL_ABI_FINGERPRINT "\n" + toolchain_identity(tools, options.flags);
    for (const int lanes : widths(options)) {
        text += "\nlanes " + std::to_string(lanes);
    }
    for (const std::string& define : options.front.defines) {
        text += "\n-D" + define;
    }
    text += options.profile ? "\nprofile" : "";
    if (options.shadeops != nullptr) {
        text += "\nshadeops " + options.shadeops->identity();
    }
    text += options.checked ? "\nchecked" : "";
    return text + (options.front.optimise ? "\noptimised" : "\nplain");
}

// The preprocessor would give the same text anywhere, any day. "%:" and "??=" also spell the sign
// that starts a directive.
bool stands_alone(std::string_view text) {
    constexpr std::string_view words[] = {"include",  "%:",       "??",
                                          "__DATE__", "__TIME__", "__TIMESTAMP__"};
    return std::none_of(std::begin(words), std::end(words), [&](std::string_view word) {
        return text.find(word) != std::string_view::npos;
    });
}

} // namespace

void use_shadeops(ObjectOptions& options, base::ShadeopLibrary& library) {
    if (library.empty()) {
        return;
    }
    options.shadeops = &library;
    options.front.find_functions = [&library](std::string_view name) {
        std::vector<ExternalFunction> found;
        for (const base::Shadeop* shadeop : library.find(name)) {
            found.push_back({shadeop->name(), shadeop->signature()});
        }
        return found;
    };
}

void report_shadeops(base::ShadeopLibrary& library, base::Diag& diag) {
    for (const std::string& problem : library.take_problems()) {
        diag.report(base::Severity::Warning, base::Code::NoFile, {}, problem);
    }
}

std::string c_text(const Program& program, int lanes, const ObjectOptions& options) {
    const Program plain = with_plain_files(program);
    const Program ready = resolved(plain, options.front);
    return emit_c(ready, analyse(ready), emit_options(plain, lanes, options));
}

namespace {

// `ready`: `plain` with its area operators resolved, whose facts these are. The object keeps the IR
// of `plain`.
BuiltObject build(const Program& plain, const Program& ready, const Facts& facts,
                  const ObjectOptions& options, base::Diag& diag) {
    const auto tools = find_toolchain(options.front.preprocessor, diag);
    if (!tools) {
        return {};
    }
    std::vector<VariantText> variants;
    for (const int lanes : widths(options)) {
        variants.push_back({lanes, emit_c(ready, facts, emit_options(plain, lanes, options))});
    }
    auto bytes = build_shared_object(*tools, variants, options.flags, plain.name,
                                     options.front.cancelled, diag);
    return bytes ? BuiltObject{Outcome::Done, std::move(*bytes)} : BuiltObject{};
}

} // namespace

BuiltObject build_object(const Program& program, const ObjectOptions& options, base::Diag& diag) {
    const Program plain = with_plain_files(program);
    const Program ready = resolved(plain, options.front);
    return build(plain, ready, analyse(ready), options, diag);
}

namespace {

// With the bits of the general code.
CompileOptions exactly(const CompileOptions& options) {
    CompileOptions exact = options;
    exact.exact = true;
    return exact;
}

// Branches on parameters cost next to nothing where they are not taken, so constants alone save
// little: 1 to 7 % of seven shaders (benchmark "corpus", docs/design/slc-speed.md, spd-003). What
// no longer has to be filled in, and evaluation at the auxiliary points, count by themselves.
double expected_gain(const sl_object& general, const Facts& special) {
    constexpr double of_constants = 0.03, of_variable = 0.02, of_area = 0.2, most = 0.5;
    const auto gone = static_cast<double>(std::popcount(general.needed & ~special.needed));
    const bool lost_area = ((general.facts & ~special.facts) & SL_FACT_area_operators) != 0;
    return std::min(most, of_constants + of_variable * gone + (lost_area ? of_area : 0));
}

} // namespace

std::optional<SpecialOrder> special_order(const sl_object& general,
                                          std::span<const ConstantParam> constants,
                                          const ObjectOptions& options, std::string& error) {
    auto special = specialise(general.ir != nullptr ? general.ir : "", constants, error);
    if (!special) {
        return std::nullopt;
    }
    base::Diag unheard(base::Diag::Deferred::Yes); // general shaders go on running
    const auto tools = find_toolchain(options.front.preprocessor, unheard);
    if (!tools) {
        error = "no C compiler";
        return std::nullopt;
    }
    SpecialOrder order;
    order.special = std::move(*special);
    order.gain =
        expected_gain(general, analyse(resolved(order.special.program, exactly(options.front))));
    order.kept_needed = general.needed & (1ULL << SL_VAR_P | 1ULL << SL_VAR_N);
    base::Sha256 hash;
    order.key = hash.add_field("specialised")
                    .add_field(print_ir(order.special.program))
                    .add_field(std::to_string(order.kept_needed))
                    .add_field(settings_text(*tools, options))
                    .hex();
    return order;
}

// Lights get N from the batch they light, and find their shadow rays' origin by its P: where they
// run, these stay what they are in the general shader.
BuiltObject build_special(const SpecialOrder& order, const ObjectOptions& options,
                          base::Diag& diag) {
    const Program ready = resolved(order.special.program, exactly(options.front));
    Facts facts = analyse(ready);
    if ((facts.facts & (SL_FACT_lights | SL_FACT_ambient)) != 0) {
        facts.needed |= order.kept_needed;
    }
    return build(order.special.program, ready, facts, options, diag);
}

std::optional<std::string> compile_to_bytes(const std::string& sl_path,
                                            const ObjectOptions& options, base::Diag& diag) {
    const Unit unit = compile_file(sl_path, options.front, diag);
    if (!unit.ok()) {
        return std::nullopt;
    }
    if (unit.programs.empty()) {
        diag.report(base::Severity::Error, base::Code::NoShader, {},
                    sl_path + " defines no shader");
        return std::nullopt;
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
    BuiltObject built = build_object(*chosen, options, diag);
    return built.outcome == Outcome::Done ? std::optional(std::move(built.bytes)) : std::nullopt;
}

bool compile_to_object(const std::string& sl_path, const std::string& slo_path,
                       const ObjectOptions& options, base::Diag& diag) {
    ::unlink(slo_path.c_str()); // must not pass for the result of this compilation
    const auto bytes = compile_to_bytes(sl_path, options, diag);
    const std::string error = bytes ? base::write_file_atomically(slo_path, *bytes) : "";
    if (!error.empty()) {
        diag.report(base::Severity::Error, base::Code::NoFile, {}, error);
    }
    return bytes && error.empty();
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
    const std::string settings = settings_text(*tools, options);
    const auto key_of = [&](std::string_view source) {
        base::Sha256 hash;
        return hash.add_field(source).add_field(base_name(sl_path)).add_field(settings).hex();
    };
    if (stands_alone(*text)) {
        return key_of(*text);
    }
    std::error_code error;
    base::Sha256 request_hash;
    request_hash.add_field(std::filesystem::absolute(sl_path, error).string()).add_field(settings);
    for (const std::string& directory : options.front.include_dirs) {
        request_hash.add_field(std::filesystem::absolute(directory, error).string());
    }
    const std::string request = request_hash.hex();
    const KeyIndex index(options.index_dir);
    if (!options.index_dir.empty()) {
        if (auto key = index.find(request)) {
            return key;
        }
    }
    text = preprocess_file(sl_path, options.front, diag);
    if (!text) {
        return std::nullopt;
    }
    std::string key = key_of(without_directories(*text));
    if (!options.index_dir.empty()) {
        const Inclusions made_from = inclusions(*text, sl_path, options.front.include_dirs);
        if (made_from.is_certain) {
            index.store(request, key, made_from.files, made_from.missing);
        }
    }
    return key;
}

} // namespace slc
