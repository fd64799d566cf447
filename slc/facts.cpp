// SPDX-License-Identifier: Apache-2.0
// What the engine wants to know of a shader: needed, written and auxiliary variables, and
// SL_FACT_*. Needs: resolve_area_operators(). Changes nothing.
#include "slc/compiler.h"
#include "slc/ir_util.h"
#include "slc/liveness.h"
#include "slc/source.h"

#include <algorithm>

namespace slc {

namespace {

class Analysis {
public:
    explicit Analysis(const Program& program) : program_(program), live_(program) {}
    Facts run();

private:
    void find_aux_params();
    void block(const Block& b);
    void statement(const Stmt& s);
    void call(const Stmt& s);
    void opacity(const Stmt& s);
    void explain(const Stmt& s);
    void reason(int variable, const Stmt& s, const std::string& by);
    [[nodiscard]] std::uint32_t spaces(const Stmt& s) const;
    [[nodiscard]] bool copies_Os(const Stmt& s) const;
    [[nodiscard]] const Var& var(VarId id) const {
        return program_.vars[static_cast<std::size_t>(id)];
    }
    [[nodiscard]] bool is_light() const { return program_.shader_type == SL_SHADER_light; }

    const Program& program_;
    Liveness live_;
    Facts facts_;
    std::uint64_t explained_ = 0;
};

constexpr std::uint64_t bit(int variable) {
    return 1ull << variable;
}
constexpr std::uint64_t light_bits = bit(SL_VAR_L) | bit(SL_VAR_Cl) | bit(SL_VAR_Ol);

Facts Analysis::run() {
    // Inside light statements L, Cl and Ol are the statement's; elsewhere only a light shader has
    // Cl and Ol.
    const std::uint64_t local = is_light() ? bit(SL_VAR_L) : light_bits;
    facts_.needed = live_.at_entry().globals() & ~local;
    facts_.written = written_globals(program_, program_.body) & ~(is_light() ? 0 : light_bits);
    block(program_.body);
    for (const Param& p : program_.params) { // "object" is "shader" there
        for (const Stmt& s : p.init) {
            facts_.facts |= spaces(s) != 0 ? SL_FACT_shader_space : 0;
        }
    }
    facts_.needed_aux = live_.at_entry().globals(1) | live_.at_entry().globals(2);
    for (const VarId id : written_differences(program_)) {
        facts_.written_aux |= bit(var(id).index);
    }
    find_aux_params();
    const bool any_param = std::find(facts_.aux_params.begin(), facts_.aux_params.end(), true) !=
                           facts_.aux_params.end();
    const bool any_aux = facts_.needed_aux != 0 || any_param;
    if (any_param) { // their differences are taken along the steps
        facts_.needed |= bit(SL_VAR_du) | bit(SL_VAR_dv);
    }
    facts_.facts |= any_aux ? SL_FACT_area_operators : 0;
    return std::move(facts_);
}

// Emitted code loads the differences of every parameter the program mentions.
void Analysis::find_aux_params() {
    facts_.aux_params.assign(program_.params.size(), false);
    for (const Var& v : program_.vars) {
        if (v.kind == VarKind::Param && v.aux != 0) {
            facts_.aux_params[static_cast<std::size_t>(v.index)] = true;
        }
    }
}

void Analysis::block(const Block& b) {
    for (const Stmt& s : b) {
        statement(s);
    }
}

void Analysis::statement(const Stmt& s) {
    // Every statement counts, even one pass_dead_code would remove: unoptimised programs still run
    // it.
    switch (s.op) {
    case Op::Call:
        call(s);
        break;
    case Op::Difference:
        facts_.facts |= spaces(s);
        break;
    case Op::Illuminance:
        facts_.facts |= SL_FACT_lights;
        break;
    case Op::Solar:
        facts_.facts |= SL_FACT_solar;
        [[fallthrough]];
    case Op::Illuminate:
        facts_.facts |= SL_FACT_directional;
        break;
    default:
        break;
    }
    opacity(s);
    explain(s);
    for (const Block& b : s.bodies) {
        block(b);
    }
}

void Analysis::call(const Stmt& s) {
    static constexpr struct {
        Property property;
        std::uint32_t fact;
    } facts[] = {{PropLights, SL_FACT_lights},
                 {PropTraces, SL_FACT_traces},
                 {PropTextures, SL_FACT_textures},
                 {PropState, SL_FACT_attributes},
                 {PropRandom, SL_FACT_random}};
    const BuiltinRow& row = builtin_of(s);
    for (const auto& f : facts) {
        facts_.facts |= row.has(f.property) ? f.fact : 0;
    }
    facts_.facts |= row.name == "ambient" ? SL_FACT_ambient : 0;
    facts_.facts |= spaces(s);
}

// "object" and "shader", or a name that is not known before the shader runs.
std::uint32_t Analysis::spaces(const Stmt& s) const {
    std::uint32_t found = 0;
    for (const VarId id : s.args) {
        const Var& v = var(id);
        const bool calls = s.op == Op::Call || s.op == Op::Difference;
        if (!calls || !builtin_of(s).has(PropSpaces) || v.type != Type::String) {
            continue;
        }
        const bool known = v.kind == VarKind::Const;
        found |= !known || v.text == "object" ? SL_FACT_object_space : 0;
        found |= !known || v.text == "shader" ? SL_FACT_shader_space : 0;
    }
    return found;
}

bool Analysis::copies_Os(const Stmt& s) const {
    return s.op == Op::Copy && is_global(var(s.args[0]), SL_VAR_Os);
}

void Analysis::opacity(const Stmt& s) {
    for_each_write(s, [&](VarId id, bool) {
        if (!is_global(var(id))) {
            return;
        }
        // Oi = Os leaves the opacity the primitive has.
        const bool changes_opacity =
            (var(id).index == SL_VAR_Oi && !copies_Os(s)) || var(id).index == SL_VAR_Os;
        facts_.facts |= changes_opacity ? SL_FACT_writes_opacity : 0;
    });
}

void Analysis::reason(int variable, const Stmt& s, const std::string& by) {
    if ((facts_.needed & bit(variable)) == 0 || (explained_ & bit(variable)) != 0) {
        return;
    }
    explained_ |= bit(variable);
    const std::string file =
        s.loc.file < program_.files.size() ? program_.files[s.loc.file] : std::string("?");
    facts_.reasons.push_back(std::string(variable_rows()[static_cast<std::size_t>(variable)].name) +
                             ": " + by + " at " + file + ":" + std::to_string(s.loc.line) + ":" +
                             std::to_string(s.loc.col));
}

// The first statement that matters and reads the variable.
void Analysis::explain(const Stmt& s) {
    if (!live_.matters(s)) {
        return;
    }
    for_each_read(s, [&](VarId id) {
        if (is_global(var(id))) {
            reason(var(id).index, s, "read");
        }
    });
    for (int i = 0; s.op == Op::Call && i < SL_VAR_COUNT; ++i) {
        if ((builtin_of(s).reads >> i & 1) != 0) {
            std::string_view name = builtin_of(s).name;
            if (builtin_of(s).has(PropHidden)) { // what the user wrote
                name.remove_suffix(std::string_view("_d").size());
            }
            reason(i, s, "read by " + std::string(name) + "()");
        }
    }
}

std::string names_of(std::uint64_t mask) {
    std::string out;
    for (int i = 0; i < SL_VAR_COUNT; ++i) {
        out += (mask >> i & 1) != 0
                   ? " " + std::string(variable_rows()[static_cast<std::size_t>(i)].name)
                   : "";
    }
    return out;
}

} // namespace

Facts analyse(const Program& program) {
    return Analysis(program).run();
}

std::string facts_text(const Program& program, const Facts& facts) {
    static constexpr struct {
        std::uint32_t fact;
        std::string_view name;
    } names[] = {{SL_FACT_lights, "lights"},
                 {SL_FACT_ambient, "ambient"},
                 {SL_FACT_directional, "directional"},
                 {SL_FACT_area_operators, "area_operators"},
                 {SL_FACT_traces, "traces"},
                 {SL_FACT_textures, "textures"},
                 {SL_FACT_object_space, "object_space"},
                 {SL_FACT_attributes, "attributes"},
                 {SL_FACT_random, "random"},
                 {SL_FACT_solar, "solar"},
                 {SL_FACT_writes_opacity, "writes_opacity"},
                 {SL_FACT_shader_space, "shader_space"}};
    std::string out =
        std::string(shader_type_name(program.shader_type)) + " " + program.name + "\n";
    out += "needed:" + names_of(facts.needed) + "\nwritten:" + names_of(facts.written) +
           "\nneeded_aux:" + names_of(facts.needed_aux) +
           "\nwritten_aux:" + names_of(facts.written_aux) + "\nfacts:";
    for (const auto& n : names) {
        out += (facts.facts & n.fact) != 0 ? " " + std::string(n.name) : "";
    }
    out += "\n";
    for (const std::string& r : facts.reasons) {
        out += "  " + r + "\n";
    }
    return out;
}

} // namespace slc
