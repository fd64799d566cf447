// SPDX-License-Identifier: Apache-2.0
// The program slctell: prints the interface of compiled shaders, as text or JSON.
// Defaults are found the way the engine finds them, by running the shader's init code; the spaces
// it asks for are noted instead of being transformed into, so a default reads `"shader" [0 0 0]`.
#include "runtime/base/ar_file.h"
#include "runtime/base/option_table.h"
#include "runtime/base/search_path.h"
#include "runtime/shader.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <span>
#include <string_view>

namespace {

enum class Switch {
#define SLCTELL_OPTION(id, name, arguments, metavar, help) id,
#include "slc/slctell_options.def"
#undef SLCTELL_OPTION
};

constexpr base::OptionRow switches[] = {
#define SLCTELL_OPTION(id, name, arguments, metavar, help) {name, arguments, metavar, help},
#include "slc/slctell_options.def"
#undef SLCTELL_OPTION
};

std::string usage_text() {
    return "usage: slctell [options] shader...\n"
           "Prints type, parameters and needed variables of compiled shaders. A shader is a path, "
           "a "
           "name that is looked\nup on the path in the environment variable SHADERS (default: the "
           "current directory), or a package or\ndirectory: all in it.\n\n" +
           base::option_lines(switches, 14, '=') +
           "\nExit status: 0 done, 1 a shader was not found or is broken, 2 wrong usage.\n";
}

constexpr const char* shader_types[] = {"surface", "displacement", "light",
                                        "volume",  "imager",       "transformation"};

constexpr const char* variable_names[] = {
#define SL_VAR(name, type, detail, readable, writable, note) #name,
#include "runtime/abi/sl_variables.def"
#undef SL_VAR
};

constexpr struct {
    std::uint32_t bit;
    const char* name;
} fact_names[] = {{SL_FACT_lights, "lights"},
                  {SL_FACT_ambient, "ambient"},
                  {SL_FACT_directional, "directional"},
                  {SL_FACT_area_operators, "area_operators"},
                  {SL_FACT_traces, "traces"},
                  {SL_FACT_textures, "textures"},
                  {SL_FACT_object_space, "object_space"},
                  {SL_FACT_shader_space, "shader_space"},
                  {SL_FACT_attributes, "attributes"},
                  {SL_FACT_random, "random"},
                  {SL_FACT_solar, "solar"},
                  {SL_FACT_writes_opacity, "writes_opacity"}};

// What default expressions may ask for.
struct Asked {
    rt::StringTable* strings = nullptr;
    std::string space; // the first space named, "" = none
};

std::int32_t note_space(void* engine, sl_string from, sl_string to, std::uint32_t, float* m) {
    auto* asked = static_cast<Asked*>(engine);
    const std::string_view source = from ? from : "";
    const std::string_view target = to ? to : "";
    if (asked->space.empty()) {
        asked->space = source == "current" || source.empty() ? target : source;
    }
    for (int i = 0; i < 16; ++i) {
        m[i] = i % 5 == 0 ? 1.0F : 0.0F;
    }
    return 1;
}

sl_services telling_services() {
    sl_services s{};
    s.loop_steps = [](void*, std::uint32_t used, std::uint32_t, sl_string,
                      std::int32_t) -> std::uint32_t { return used < (1U << 20) ? 1U << 20 : 0; };
    s.light_count = [](void*) -> std::int32_t { return 0; };
    s.light = [](void*, const sl_light_query*, sl_light_result*) -> std::uint32_t { return 0; };
    s.ambient = [](void*, std::uint32_t, std::uint32_t, const float*, float*) {};
    s.space = note_space;
    s.message = [](void*, std::int32_t, sl_string, std::int32_t, std::int32_t, std::uint32_t,
                   std::uint32_t, float*) -> std::uint32_t { return 0; };
    s.print = [](void*, std::uint32_t, sl_string) {};
    s.print_uniform = [](void*, std::uint32_t, sl_string) {};
    s.intern = [](void* engine, const char* text) {
        return static_cast<Asked*>(engine)->strings->intern(text);
    };
    s.shader_name = [](void*, sl_string) -> sl_string { return ""; };
    s.report = [](void*, std::int32_t, const char*) {};
    s.depth_range = [](void*, float* near_far) {
        near_far[0] = 0;
        near_far[1] = 1;
    };
    s.raylevel = [](void*) -> std::int32_t { return 0; };
    s.ray_kind = [](void*) -> std::int32_t { return 0; };
    return s;
}

std::string number(float value) {
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
    return {text.data(), end};
}

// As a C, RIB and JSON string.
std::string string_literal(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') {
            out += '\\';
            out += c;
        } else if (static_cast<unsigned char>(c) < 32) {
            std::array<char, 8> code{};
            std::snprintf(code.data(), code.size(), "\\u%04x", static_cast<unsigned>(c));
            out += code.data();
        } else {
            out += c;
        }
    }
    return out + "\"";
}

// A shader with everything that is printed about it.
class Told {
public:
    Told(const rt::ShaderObject& shader, rt::StringTable& strings) : shader_(shader) {
        base::Diag quiet(nullptr);
        quiet.set_handler(base::ErrorHandler::Ignore);
        const sl_services services = telling_services();
        Asked asked{&strings, {}};
        const rt::ShaderInstance instance(shader, {}, services, &asked, strings, quiet);
        const sl_object& o = shader.object();
        for (int i = 0; i < o.num_params; ++i) {
            defaults_.push_back(values(instance, i));
            spaces_.push_back(space_of(instance, i, services, strings));
        }
    }

    void print_text() const;
    void print_json(bool first) const;

private:
    [[nodiscard]] static std::vector<std::string> values(const rt::ShaderInstance& instance,
                                                         int param);
    [[nodiscard]] std::string space_of(const rt::ShaderInstance& instance, int param,
                                       const sl_services& services, rt::StringTable& strings) const;
    [[nodiscard]] std::string default_text(int param) const;

    const rt::ShaderObject& shader_;
    std::vector<std::vector<std::string>> defaults_; // one text per number or string
    std::vector<std::string> spaces_;
};

std::vector<std::string> Told::values(const rt::ShaderInstance& instance, int param) {
    const sl_param& p = instance.object().params[param];
    const int n = std::max(p.array_length, 1) * rt::components_of(p.type);
    std::vector<std::string> texts;
    for (int k = 0; k < n; ++k) {
        texts.push_back(p.type == SL_TYPE_string
                            ? string_literal(instance.uniform_strings(param)[k])
                            : number(instance.uniform_floats(param)[k]));
    }
    return texts;
}

// Runs init for this parameter alone, all others being bound.
std::string Told::space_of(const rt::ShaderInstance& instance, int param,
                           const sl_services& services, rt::StringTable& strings) const {
    const sl_object& o = shader_.object();
    std::vector<std::byte> block(instance.params().begin(), instance.params().end());
    std::vector<std::uint8_t> bound(static_cast<std::size_t>(o.num_params), 1);
    bound[static_cast<std::size_t>(param)] = 0;
    Asked asked{&strings, {}};
    const sl_init init{block.data(), bound.data(), shader_.strings().data(), &services, &asked};
    shader_.variant().init(&init);
    return asked.space;
}

std::string Told::default_text(int param) const {
    const sl_param& p = shader_.object().params[param];
    const auto& texts = defaults_[static_cast<std::size_t>(param)];
    if (p.array_length == 0 && rt::components_of(p.type) == 1) {
        return texts.empty() ? "" : texts.front();
    }
    std::string list;
    for (const std::string& t : texts) {
        list += (list.empty() ? "" : " ") + t;
    }
    std::string prefix;
    if (p.type == SL_TYPE_color) {
        prefix = "\"rgb\" ";
    } else if (p.type >= SL_TYPE_point && p.type <= SL_TYPE_matrix) {
        const std::string& space = spaces_[static_cast<std::size_t>(param)];
        prefix = string_literal(space.empty() ? "current" : space) + " ";
    }
    return prefix + "[" + list + "]";
}

template <class Print> void for_each_variable(std::uint64_t mask, Print print) {
    for (int id = 0; id < SL_VAR_COUNT; ++id) {
        if ((mask >> id & 1U) != 0) {
            print(variable_names[id]);
        }
    }
}

std::string variables(std::uint64_t mask) {
    std::string text;
    for_each_variable(
        mask, [&](const char* name) { text += (text.empty() ? "" : " ") + std::string(name); });
    return text.empty() ? "none" : text;
}

void Told::print_text() const {
    const sl_object& o = shader_.object();
    std::printf("%s \"%s\"\n", shader_types[o.type], o.name);
    for (int i = 0; i < o.num_params; ++i) {
        const sl_param& p = o.params[i];
        std::printf("    \"%s\" \"%sparameter %s %s\"\n        Default value: %s\n", p.name,
                    p.is_output ? "output " : "",
                    p.detail == SL_DETAIL_varying ? "varying" : "uniform",
                    rt::type_text(p.type, p.array_length).c_str(), default_text(i).c_str());
    }
    std::printf("    needs: %s\n    sets: %s\n", variables(o.needed).c_str(),
                variables(o.written).c_str());
}

std::string json_variables(std::uint64_t mask) {
    std::string text;
    for_each_variable(
        mask, [&](const char* name) { text += (text.empty() ? "" : ", ") + string_literal(name); });
    return "[" + text + "]";
}

void Told::print_json(bool first) const {
    const sl_object& o = shader_.object();
    std::printf("%s  {\"name\": %s, \"type\": \"%s\", \"source\": %s,\n   \"parameters\": [",
                first ? "" : ",\n", string_literal(o.name).c_str(), shader_types[o.type],
                string_literal(o.source ? o.source : "").c_str());
    for (int i = 0; i < o.num_params; ++i) {
        const sl_param& p = o.params[i];
        std::printf(
            "%s\n    {\"name\": %s, \"type\": \"%s\", \"array_length\": %d, \"detail\": \"%s\", "
            "\"output\": %s, \"space\": %s, \"default\": [",
            i > 0 ? "," : "", string_literal(p.name).c_str(), rt::type_text(p.type, 0).c_str(),
            p.array_length, p.detail == SL_DETAIL_varying ? "varying" : "uniform",
            p.is_output ? "true" : "false",
            string_literal(spaces_[static_cast<std::size_t>(i)]).c_str());
        const char* separator = "";
        for (const std::string& value : defaults_[static_cast<std::size_t>(i)]) {
            std::printf("%s%s", separator, value.c_str());
            separator = ", ";
        }
        std::printf("]}");
    }
    std::printf("],\n   \"needs\": %s, \"sets\": %s, \"facts\": [",
                json_variables(o.needed).c_str(), json_variables(o.written).c_str());
    const char* separator = "";
    for (const auto& fact : fact_names) {
        if ((o.facts & fact.bit) != 0) {
            std::printf("%s\"%s\"", separator, fact.name);
            separator = ", ";
        }
    }
    std::printf("], \"lanes\": [");
    for (int i = 0; i < o.num_variants; ++i) {
        std::printf("%s%d", i > 0 ? ", " : "", o.variants[i]->lanes);
    }
    std::printf("]}");
}

std::vector<std::string> search_path() {
    const char* variable = std::getenv("SHADERS");
    return base::expand_search_path(variable && *variable ? variable : ".");
}

// A package or directory stands for the objects in it.
std::vector<std::string> expanded(const std::string& name) {
    namespace fs = std::filesystem;
    std::vector<std::string> names;
    std::error_code error;
    std::string why;
    if (fs::is_directory(name, error)) {
        for (const auto& entry : fs::directory_iterator(name, error)) {
            if (entry.path().extension() == ".slo") {
                names.push_back(entry.path().string());
            }
        }
        std::sort(names.begin(), names.end());
    } else if (const auto package = base::ArFile::open(name, why)) {
        for (const std::string& member : package->names()) {
            const bool is_path = name.find('/') != std::string::npos; // else it would be searched
            names.push_back((is_path ? name : "./" + name) + "/" + member);
        }
    } else {
        names.push_back(name);
    }
    return names;
}

struct Options {
    bool json = false, list = false, help = false, version = false;
    std::vector<std::string> names;
    std::string error; // not empty: wrong usage
};

Options parse(std::span<char* const> arguments) {
    Options options;
    for (const std::string_view argument : arguments) {
        const auto* row = std::find_if(std::begin(switches), std::end(switches),
                                       [&](const auto& r) { return r.name == argument; });
        if (row == std::end(switches)) {
            if (argument.starts_with("-")) {
                options.error = "unknown option " + std::string(argument);
            }
            options.names.emplace_back(argument);
            continue;
        }
        switch (static_cast<Switch>(row - switches)) {
        case Switch::json:
            options.json = true;
            break;
        case Switch::list:
            options.list = true;
            break;
        case Switch::help:
            options.help = true;
            break;
        case Switch::version:
            options.version = true;
            break;
        }
    }
    if (options.names.empty() && options.error.empty()) {
        options.error = "no shader named";
    }
    return options;
}

void tell(const Options& options, rt::ShaderLibrary& library, rt::StringTable& strings) {
    bool first = true;
    for (const std::string& given : options.names) {
        for (const std::string& name : expanded(given)) {
            const rt::ShaderObject* shader = library.find_any(name, {});
            if (!shader) {
                continue;
            }
            if (options.list) {
                std::printf("%s %s\n", shader_types[shader->object().type], shader->object().name);
                continue;
            }
            const Told told(*shader, strings);
            options.json ? told.print_json(first) : told.print_text();
            first = false;
        }
    }
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parse({argv + (argc > 0 ? 1 : 0), argv + argc});
    if (options.help) {
        std::fputs(usage_text().c_str(), stdout);
        return 0;
    }
    if (options.version) {
        std::printf("slctell (Perigee) %s\n", PERIGEE_VERSION);
        return 0;
    }
    if (!options.error.empty()) {
        std::fprintf(stderr, "slctell: %s; see slctell --help\n", options.error.c_str());
        return 2;
    }
    base::Diag diag;
    rt::StringTable strings;
    rt::ShaderLibrary::Config config;
    config.search_path = search_path();
    config.trust_all = true; // the user named the shader
    rt::ShaderLibrary library(std::move(config), strings, diag);
    const bool json = options.json && !options.list;
    std::fputs(json ? "[\n" : "", stdout);
    tell(options, library, strings);
    std::fputs(json ? "\n]\n" : "", stdout);
    return diag.had_errors() ? 1 : 0;
}
