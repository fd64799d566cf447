// SPDX-License-Identifier: Apache-2.0
// The file around the emitter's core, in C: parameter block, constants, the two entry points, the
// descriptor.
#include "slc/emit_c.h"

#include "sl_fingerprint.h"
#include "slc/builtins.h"
#include "slc/emit_common.h"

#include <algorithm>

namespace slc {

namespace {

constexpr Dialect c_dialect = {
    {"float", "slu3", "slum", "sl_string"}, {"slf", "slv", "slm", "sls"}, "int", "sli", ""};

constexpr std::uint32_t slot_alignment = 16;

std::uint32_t bytes_of(const Var& p) {
    const std::uint32_t unit = p.type == Type::String ? sizeof(sl_string) : sizeof(float);
    return unit * static_cast<std::uint32_t>(std::max(p.array_length, 1) * num_components(p.type));
}

class CFile {
public:
    CFile(const Program& program, const Facts& facts, const EmitOptions& options)
        : program_(program), facts_(facts), options_(options), waits_(program),
          names_(c_names(program)) {}

    std::string text() {
        head();
        param_block();
        constant_arrays();
        shade();
        init();
        variant();
        if (options_.variants.front() == options_.lanes) {
            descriptor();
        }
        return out_.text();
    }

private:
    [[nodiscard]] const Var& var(VarId v) const {
        return program_.vars[static_cast<std::size_t>(v)];
    }
    [[nodiscard]] const std::string& name(VarId v) const {
        return names_[static_cast<std::size_t>(v)];
    }

    void head();
    void param_block();
    void constant_arrays();
    void shade();
    void shade_head(std::string_view frame);
    void shade_body(const Lines& body);
    void init();
    void variant();
    void descriptor();
    void ir_text();
    void profile_places();
    [[nodiscard]] std::string mask_text(std::uint64_t mask) const;

    const Program& program_;
    const Facts& facts_;
    const EmitOptions& options_;
    Suspensions waits_;
    std::vector<std::string> names_;
    StringPool strings_;
    Lines out_;
    std::vector<Loc> places_ = {Loc{}}; // of a profile
};

void CFile::head() {
    out_.line("/* " + std::string(shader_type_name(program_.shader_type)) + " " + program_.name +
              ", by slc from " + options_.source + " */");
    out_.line("#define SL_LANES " + std::to_string(options_.lanes));
    out_.line("#include <sl_shader.h>");
    if (options_.profile) {
        out_.line("#include <sl_profile.h>");
    }
    out_.line("");
}

void CFile::param_block() {
    if (program_.params.empty()) {
        return;
    }
    static constexpr std::string_view slot = " __attribute__((aligned(16)))";
    out_.open("struct params {");
    for (const Param& p : program_.params) {
        const Var& v = var(p.var);
        const std::string type(c_dialect.uniform_types[static_cast<std::size_t>(form_of(v.type))]);
        const std::string array =
            v.array_length > 0 ? "[" + std::to_string(v.array_length) + "]" : "";
        if (v.detail == Detail::Varying) {
            const std::string plane = v.type == Type::String ? "sl_string" : "float";
            out_.line(plane + " *" + name(p.var) + std::string(slot) + ";");
            out_.line(type + " " + name(p.var) + "_default" + array + std::string(slot) + ";");
        } else {
            out_.line(type + " " + name(p.var) + array + std::string(slot) + ";");
        }
    }
    out_.close("};");
    const ParamLayout layout = layout_params(program_);
    out_.line("_Static_assert(sizeof(struct params) == " + std::to_string(layout.size) +
              ", \"parameter block\");");
    out_.line("");
}

void CFile::constant_arrays() {
    for (std::size_t i = 0; i < program_.vars.size(); ++i) {
        const Var& v = program_.vars[i];
        if (v.kind != VarKind::Const || v.array_length == 0) {
            continue;
        }
        const auto n = static_cast<std::size_t>(num_components(v.type));
        std::string list;
        for (std::size_t k = 0; k < static_cast<std::size_t>(v.array_length) * n; ++k) {
            const std::string value = float_literal(k < v.values.size() ? v.values[k] : 0.0F);
            const std::string open = n == 16 ? "{{" : "{";
            list += k == 0 ? "" : ", ";
            list += (n > 1 && k % n == 0 ? open : "") + value +
                    (n > 1 && k % n == n - 1 ? (n == 16 ? "}}" : "}") : "");
        }
        out_.line("static const " +
                  std::string(c_dialect.uniform_types[static_cast<std::size_t>(form_of(v.type))]) +
                  " " + names_[i] + "[" + std::to_string(v.array_length) + "] = {" + list + "};");
    }
}

void CFile::shade() {
    Lines body(1);
    Emitter emitter(program_, program_.body, facts_.written, Emitter::Mode::Shade, c_dialect,
                    names_, strings_, body);
    if (options_.profile) {
        body.line("sl_profile_cursor profile[1];");
        body.line("sl_profile_begin(profile, call);");
        emitter.stamp_places(places_);
    }
    if (options_.checked) {
        emitter.check_numbers();
    }
    emitter.wait_at(waits_);
    emitter.emit_body();
    if (options_.profile) {
        body.line("sl_profile_at(profile, 0, live);");
    }
    if (waits_.empty()) {
        shade_head("frame");
        out_.line("(void)frame; /* this shader never suspends */");
    } else {
        emitter.declare_frame(out_);
        shade_head("sl_head");
        out_.line("struct frame *const frame = (struct frame *)(void *)sl_head;");
    }
    shade_body(body);
}

void CFile::shade_head(std::string_view frame) {
    out_.line("static sl_status shade(const sl_batch *batch, uint32_t first, uint32_t count, "
              "sl_frame *" +
              std::string(frame) + ")");
    out_.open("{");
}

void CFile::shade_body(const Lines& body) {
    out_.line("sl_call call[1];");
    out_.line("sl_call_begin(call, batch, first, count);");
    out_.line("sli live = call->live;");
    out_.line("const sl_string *const strings = batch->strings;");
    out_.line("(void)strings;");
    if (!program_.params.empty()) {
        out_.line("struct params *const params = batch->params;");
        out_.line("(void)params;");
    }
    out_.append(body);
    out_.line("return SL_DONE;");
    out_.close();
    out_.line("");
}

void CFile::init() {
    out_.line("static void init(const sl_init *init)");
    out_.open("{");
    out_.line("sl_call call[1];");
    out_.line("sl_call_begin_init(call, init);");
    out_.line("const sl_string *const strings = init->strings;");
    out_.line("(void)strings;");
    if (!program_.params.empty()) {
        out_.line("struct params *const params = init->params;");
    }
    for (std::size_t i = 0; i < program_.params.size(); ++i) {
        const Param& p = program_.params[i];
        out_.open("if (!init->bound[" + std::to_string(i) + "]) {");
        Emitter(program_, p.init, 0, Emitter::Mode::Init, c_dialect, names_, strings_, out_,
                "_" + std::to_string(i))
            .emit_body();
        out_.close();
    }
    out_.close();
    out_.line("");
}

void CFile::variant() {
    const std::string n = std::to_string(options_.lanes);
    out_.line("__attribute__((visibility(\"hidden\"))) extern const sl_variant sl_variant_" + n +
              ";");
    const std::string_view frame =
        waits_.empty() ? "0, 0" : "sizeof(struct frame), _Alignof(struct frame)";
    out_.line("const sl_variant sl_variant_" + n + " = {" +
              (options_.lanes == 8 ? "SL_ISA_avx2" : "SL_ISA_any") + ", SL_LANES, " +
              std::string(frame) + ", shade, init};");
    out_.line("");
}

std::string CFile::mask_text(std::uint64_t mask) const {
    std::string text = std::to_string(mask) + "ull /*";
    for (std::size_t id = 0; id < variable_rows().size(); ++id) {
        if ((mask >> id & 1U) != 0) {
            text += " " + std::string(variable_rows()[id].name);
        }
    }
    return text + " */";
}

void CFile::descriptor() {
    const ParamLayout layout = layout_params(program_);
    if (!program_.params.empty()) {
        out_.open("static const sl_param sl_params[] = {");
        for (std::size_t i = 0; i < program_.params.size(); ++i) {
            const Var& v = var(program_.params[i].var);
            out_.line("{" + c_string(v.name) + ", SL_TYPE_" + std::string(type_name(v.type)) +
                      ", SL_DETAIL_" + std::string(detail_name(v.detail)) + ", " +
                      std::to_string(v.array_length) + ", " + (v.is_output ? "1" : "0") + ", " +
                      std::to_string(layout.offsets[i]) + ", " +
                      (i < facts_.aux_params.size() && facts_.aux_params[i] ? "1" : "0") + "},");
        }
        out_.close("};");
    }
    if (!strings_.texts().empty()) {
        out_.open("static const char *const sl_strings[] = {");
        for (const std::string& text : strings_.texts()) {
            out_.line(c_string(text) + ",");
        }
        out_.close("};");
    }
    std::string variants;
    for (const int width : options_.variants) {
        const std::string n = std::to_string(width);
        if (width != options_.lanes) {
            out_.line(
                "__attribute__((visibility(\"hidden\"))) extern const sl_variant sl_variant_" + n +
                ";");
        }
        variants += (variants.empty() ? "&sl_variant_" : ", &sl_variant_") + n;
    }
    out_.line("static const sl_variant *const sl_variants[] = {" + variants + "};");
    ir_text();
    profile_places();
    out_.open("__attribute__((visibility(\"default\"))) const sl_object sl_shader_object = {");
    out_.line(".fingerprint = " + c_string(SL_ABI_FINGERPRINT) + ",");
    out_.line(".name = " + c_string(program_.name) + ",");
    out_.line(".type = SL_SHADER_" + std::string(shader_type_name(program_.shader_type)) + ",");
    if (!program_.params.empty()) {
        out_.line(".num_params = " + std::to_string(program_.params.size()) + ",");
        out_.line(".params = sl_params,");
        out_.line(".params_size = sizeof(struct params),");
    }
    out_.line(".facts = " + std::to_string(facts_.facts) + "u,");
    out_.line(".needed = " + mask_text(facts_.needed) + ",");
    out_.line(".written = " + mask_text(facts_.written) + ",");
    out_.line(".needed_aux = " + mask_text(facts_.needed_aux) + ",");
    out_.line(".written_aux = " + mask_text(facts_.written_aux) + ",");
    if (!strings_.texts().empty()) {
        out_.line(".num_strings = " + std::to_string(strings_.texts().size()) + ",");
        out_.line(".strings = sl_strings,");
    }
    out_.line(".num_variants = " + std::to_string(options_.variants.size()) + ",");
    out_.line(".variants = sl_variants,");
    out_.line(".ir = " + std::string(options_.ir_text.empty() ? "\"\"" : "sl_ir") + ",");
    out_.line(".source = " + c_string(options_.source) + ",");
    if (options_.profile) {
        out_.line(".num_places = " + std::to_string(places_.size()) + ",");
        out_.line(".places = sl_places,");
    }
    out_.close("};");
}

void CFile::ir_text() {
    if (options_.ir_text.empty()) {
        return;
    }
    out_.open("static const char sl_ir[] =");
    const std::string_view text = options_.ir_text;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size() - 1) + 1;
        out_.line(c_string(text.substr(at, end - at)));
        at = end;
    }
    out_.line(";");
    out_.close("");
}

void CFile::profile_places() {
    if (!options_.profile) {
        return;
    }
    out_.open("static const sl_place sl_places[] = {");
    for (const Loc& place : places_) {
        const std::string file =
            place.file < program_.files.size() ? program_.files[place.file] : options_.source;
        out_.line("{" + c_string(file) + ", " + std::to_string(place.line) + "},");
    }
    out_.close("};");
}

} // namespace

ParamLayout layout_params(const Program& program) {
    const auto slot = [](std::uint32_t bytes) {
        return (bytes + slot_alignment - 1) / slot_alignment * slot_alignment;
    };
    ParamLayout layout;
    for (const Param& p : program.params) {
        const Var& v = program.vars[static_cast<std::size_t>(p.var)];
        layout.offsets.push_back(layout.size);
        layout.size += slot(bytes_of(v)) + (v.detail == Detail::Varying ? slot_alignment : 0);
    }
    return layout;
}

std::string emit_c(const Program& program, const Facts& facts, const EmitOptions& options) {
    return CFile(program, facts, options).text();
}

} // namespace slc
