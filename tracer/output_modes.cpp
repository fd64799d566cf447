// SPDX-License-Identifier: Apache-2.0
#include "tracer/output_modes.h"

#include "ribtools/declare.h"

#include <algorithm>
#include <optional>
#include <string_view>

namespace trace {

namespace {

struct PictureRow {
    std::string_view name; // in a mode
    std::string_view variable;
    SampleValue value;
    rib::ParamType type;
};
// What the picture itself consists of. In a mode these may be written without commas: rgbaz.
constexpr PictureRow picture_rows[] = {
    {"rgb", "Ci", SampleValue::Color, rib::ParamType::Color},
    {"Ci", "Ci", SampleValue::Color, rib::ParamType::Color},
    {"Oi", "Oi", SampleValue::Opacity, rib::ParamType::Color},
    {"a", "a", SampleValue::Alpha, rib::ParamType::Float},
    {"z", "z", SampleValue::Depth, rib::ParamType::Float},
};

const PictureRow* find_picture_row(std::string_view name) {
    const auto* row = std::ranges::find(picture_rows, name, &PictureRow::name);
    return row == std::end(picture_rows) ? nullptr : row;
}

std::string_view trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(" \t");
    return first == std::string_view::npos
               ? std::string_view()
               : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::string_view last_word(std::string_view text) {
    text = trimmed(text);
    const auto blank = text.find_last_of(" \t");
    return blank == std::string_view::npos ? text : text.substr(blank + 1);
}

struct TypeRow {
    std::string_view name;
    rib::ParamType type;
};
constexpr TypeRow variable_types[] = {
#define SL_VAR(name, type, detail, readable, writable, note) {#name, rib_type_##type},
#define rib_type_float                                       rib::ParamType::Float
#define rib_type_color                                       rib::ParamType::Color
#define rib_type_point                                       rib::ParamType::Point
#define rib_type_vector                                      rib::ParamType::Vector
#define rib_type_normal                                      rib::ParamType::Normal
#include "runtime/abi/sl_variables.def"
#undef rib_type_float
#undef rib_type_color
#undef rib_type_point
#undef rib_type_vector
#undef rib_type_normal
#undef SL_VAR
};

rib::ParamDecl varying(rib::ParamType type, int array_length = 1) {
    return {rib::StorageClass::Varying, type, array_length, array_length > 1};
}

std::optional<rib::ParamDecl> type_of_variable(std::string_view name) {
    if (name == "st") { // s and t together, as primitives name them
        return varying(rib::ParamType::Float, 2);
    }
    if (find_shown_variable(name) == nullptr) {
        return std::nullopt;
    }
    const auto* row = std::ranges::find(variable_types, name, &TypeRow::name);
    return varying(row->type);
}

bool is_numeric(rib::ParamType type) {
    return type != rib::ParamType::String && type != rib::ParamType::Pointer &&
           type != rib::ParamType::MPoint;
}

class ModeReader {
public:
    ModeReader(const rib::Display& display, const rib::Options& options,
               const ShaderOutputs& shader_outputs, base::Diag& diag)
        : display_(display), options_(options), shader_outputs_(shader_outputs), diag_(diag) {}

    std::vector<ModeElement> read() {
        std::string_view rest = display_.mode.empty() ? "rgba" : std::string_view(display_.mode);
        while (true) {
            const auto comma = rest.find(',');
            if (const std::string_view text = trimmed(rest.substr(0, comma)); !text.empty()) {
                read_element(text);
            }
            if (comma == std::string_view::npos) {
                return std::move(elements_);
            }
            rest.remove_prefix(comma + 1);
        }
    }

private:
    void read_element(std::string_view text) {
        if (const rib::ParamList* channel = find_channel(text)) {
            const rib::Param& head = channel->params.front();
            const std::string source = channel->get_string("source", head.name);
            add(std::string(last_word(text)), last_word(source),
                head.guessed ? std::nullopt : std::optional(head.decl), channel);
        } else if (rib::is_inline_declaration(text)) {
            read_declaration(text);
        } else if (!read_run_together(text)) {
            add(std::string(text), text, std::nullopt, nullptr);
        }
    }

    void read_declaration(std::string_view text) {
        const rib::Declaration d = rib::parse_inline_declaration(text);
        if (!d.error.empty()) {
            warn("mode \"" + std::string(text) + "\": " + d.error + "; left out");
            return;
        }
        add(d.name, d.name, d.decl, nullptr);
    }

    // "rgbaz" and the like.
    bool read_run_together(std::string_view text) {
        std::vector<const PictureRow*> rows;
        while (!text.empty()) {
            const auto* row = std::ranges::find_if(
                picture_rows, [&](const PictureRow& r) { return text.starts_with(r.name); });
            if (row == std::end(picture_rows)) {
                return false;
            }
            rows.push_back(row);
            text.remove_prefix(row->name.size());
        }
        for (const PictureRow* row : rows) {
            add(std::string(row->variable), row->name, std::nullopt, nullptr);
        }
        return true;
    }

    // The last definition counts.
    const rib::ParamList* find_channel(std::string_view text) const {
        const std::string_view name = last_word(text);
        const auto& channels = options_.display_channels;
        const auto it = std::find_if(channels.rbegin(), channels.rend(), [&](const auto& c) {
            return last_word(c.params.front().name) == name;
        });
        return it == channels.rend() ? nullptr : &*it;
    }

    void add(std::string name, std::string_view variable, std::optional<rib::ParamDecl> decl,
             const rib::ParamList* channel) {
        ModeElement e;
        e.name = std::move(name);
        e.channel = channel;
        e.variable = variable;
        if (const PictureRow* row = find_picture_row(variable)) {
            e.variable = row->variable;
            e.value = row->value;
            e.decl = varying(row->type);
        } else if (!find_declaration(variable, decl, e.decl)) {
            return;
        }
        const bool known = std::ranges::find(elements_, e.name, &ModeElement::name) != //
                           elements_.end();
        if (!known) {
            elements_.push_back(std::move(e));
        }
    }

    // Inline, Declare, what the language predefines, what a shader of the scene declares.
    bool find_declaration(std::string_view variable, std::optional<rib::ParamDecl> decl,
                          rib::ParamDecl& out) {
        const std::optional<rib::ParamDecl> predefined = type_of_variable(variable);
        const auto of_shader = shader_outputs_.find(variable);
        if (const auto it = options_.declared_outputs.find(std::string(variable));
            !decl && it != options_.declared_outputs.end()) {
            decl = it->second;
        }
        decl = decl ? decl : predefined;
        if (!decl && of_shader != shader_outputs_.end()) {
            decl = of_shader->second;
        }
        if (!decl) {
            warn("mode names \"" + std::string(variable) +
                 "\", which is neither a channel (rgb, a, z), a variable of surfaces, nor declared "
                 "or an output of a shader; left out");
            return false;
        }
        if (!is_numeric(decl->type)) {
            warn("mode names \"" + std::string(variable) + "\", a " + rib::declaration_text(*decl) +
                 ": pictures hold numbers; left out");
            return false;
        }
        if (!predefined && of_shader == shader_outputs_.end()) {
            warn("no displacement, surface or atmosphere shader of the scene has an output "
                 "parameter \"" +
                 std::string(variable) + "\"; its channels are 0");
        }
        out = *decl;
        return true;
    }

    void warn(const std::string& text) {
        diag_.report(base::Severity::Warning, base::Code::BadToken, display_.pos,
                     "Display \"" + display_.name + "\": " + text);
    }

    const rib::Display& display_;
    const rib::Options& options_;
    const ShaderOutputs& shader_outputs_;
    base::Diag& diag_;
    std::vector<ModeElement> elements_;
};

} // namespace

std::vector<ModeElement> read_mode(const rib::Display& display, const rib::Options& options,
                                   const ShaderOutputs& shader_outputs, base::Diag& diag) {
    return ModeReader(display, options, shader_outputs, diag).read();
}

} // namespace trace
