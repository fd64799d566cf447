// SPDX-License-Identifier: Apache-2.0
#include "slc/aux_analysis.h"

#include "slc/ir_util.h"
#include "slc/liveness.h"

#include <algorithm>

namespace slc {

AuxRule aux_rule(const Stmt& call) {
    const BuiltinRow& row = builtin_of(call);
    if (row.has(PropArea)) {
        return AuxRule::Operator;
    }
    constexpr std::uint32_t state = PropRandom | PropLights | PropTraces | PropMessage;
    const bool acts =
        row.has(PropEffect) && std::none_of(row.args.begin(), row.args.end(),
                                            [](const ArgSpec& a) { return a.is_output; });
    return (row.properties & state) != 0 || acts ? AuxRule::MainOnly : AuxRule::Function;
}

Axes axes_of_operator(std::string_view name) {
    return name == "Du" ? AxisU : name == "Dv" ? AxisV : BothAxes;
}

Axes axes_of_global(sl_shader_type type, int variable) {
    if (type == SL_SHADER_light) { // the place that is lit moves, the light does not
        return variable == SL_VAR_Ps || variable == SL_VAR_Ns ? BothAxes : NoAxis;
    }
    if (type != SL_SHADER_surface && type != SL_SHADER_displacement) {
        return NoAxis;
    }
    switch (variable) {
    case SL_VAR_u:
        return AxisU;
    case SL_VAR_v:
        return AxisV;
    case SL_VAR_P:
    case SL_VAR_N:
    case SL_VAR_Ng:
    case SL_VAR_I:
    case SL_VAR_dPdu:
    case SL_VAR_dPdv:
    case SL_VAR_s:
    case SL_VAR_t:
    case SL_VAR_Cs:
    case SL_VAR_Os:
        return BothAxes;
    default:
        return NoAxis;
    }
}

namespace {

void find_operators(const Block& b, std::vector<const Stmt*>& found) {
    for (const Stmt& s : b) {
        if (s.op == Op::Call && builtin_of(s).has(PropArea)) {
            found.push_back(&s);
        }
        for (const Block& inner : s.bodies) {
            find_operators(inner, found);
        }
    }
}

} // namespace

std::vector<const Stmt*> area_operators(const Block& b) {
    std::vector<const Stmt*> found;
    find_operators(b, found);
    return found;
}

AuxAnalysis::AuxAnalysis(const Program& program, std::uint64_t results, const Liveness& slice)
    : program_(program), slice_(slice), differs_(program.vars.size(), 0),
      uses_(program.vars.size(), Interval{0, -1}) {
    number(program.body);
    seed(results);
    do {
        changed_ = false;
        block(program.body);
    } while (changed_);
}

// Statements are numbered in the order of the text; what a statement holds lies in its interval.
void AuxAnalysis::number(const Block& b) {
    const int first = next_;
    for (const Stmt& s : b) {
        const int begin = next_++;
        for_each_read(s, [&](VarId id) { note_use(id); });
        for_each_write(s, [&](VarId id, bool) { note_use(id); });
        for (const Block& inner : s.bodies) {
            number(inner);
        }
        statements_[&s] = {begin, next_ - 1};
    }
    blocks_[&b] = {first, next_ - 1};
}

void AuxAnalysis::note_use(VarId id) {
    Interval& u = uses_[static_cast<std::size_t>(id)];
    u = u.last < u.first ? Interval{next_ - 1, next_ - 1} : Interval{u.first, next_ - 1};
}

bool AuxAnalysis::outside(VarId id, Interval where) const {
    const VarKind kind = var(id).kind;
    const Interval& u = uses_[static_cast<std::size_t>(id)];
    return kind == VarKind::Global || kind == VarKind::Param || u.first < where.first ||
           u.last > where.last;
}

bool AuxAnalysis::used_outside(VarId id, const Stmt& s) const {
    return outside(id, statements_.at(&s));
}

bool AuxAnalysis::used_outside(VarId id, const Block& b) const {
    return outside(id, blocks_.at(&b));
}

void AuxAnalysis::seed(std::uint64_t results) {
    unsigned axes = results != 0 ? BothAxes : NoAxis;
    for (const Stmt* s : area_operators(program_.body)) {
        axes |= axes_of_operator(builtin_of(*s).name);
    }
    axes_ = axes;
    const bool has_primitive =
        program_.shader_type == SL_SHADER_surface || program_.shader_type == SL_SHADER_displacement;
    for (std::size_t i = 0; i < program_.vars.size(); ++i) {
        const Var& v = program_.vars[i];
        unsigned given = NoAxis;
        if (v.kind == VarKind::Global) {
            given = axes_of_global(program_.shader_type, v.index);
        } else if (v.kind == VarKind::Param && v.detail == Detail::Varying && has_primitive) {
            given = v.type == Type::String ? NoAxis : BothAxes; // a primitive variable
        }
        differs_[i] = static_cast<std::uint8_t>(given & axes);
    }
}

Axes AuxAnalysis::differs(VarId id) const {
    const auto i = static_cast<std::size_t>(id);
    if (i < differs_.size()) {
        return differs_[i];
    }
    return is_global(var(id)) ? axes_of_global(program_.shader_type, var(id).index) & axes_
                              : NoAxis;
}

unsigned AuxAnalysis::global_axes(int variable) const {
    unsigned axes = axes_of_global(program_.shader_type, variable);
    for (std::size_t i = 0; i < program_.vars.size(); ++i) { // assigned: what the program says
        if (is_global(program_.vars[i], variable)) {
            axes = differs_[i];
        }
    }
    return axes & axes_;
}

void AuxAnalysis::block(const Block& b) {
    for (const Stmt& s : b) {
        statement(s);
    }
}

void AuxAnalysis::statement(const Stmt& s) {
    if (s.op == Op::Break || s.op == Op::Continue || s.op == Op::Leave) {
        jump(s);
        return;
    }
    const bool by_lights = is_loop(s.op) && s.op != Op::Loop;
    const unsigned axes = by_lights || (s.op == Op::Call && aux_rule(s) == AuxRule::MainOnly)
                              ? NoAxis
                              : value_axes(s);
    for_each_write(s, [&](VarId id, bool) { raise_assigned(id, axes); });
    if (s.op == Op::Illuminate || s.op == Op::Solar) {
        for (std::size_t i = 0; i < program_.vars.size(); ++i) {
            if (is_global(program_.vars[i], SL_VAR_L)) {
                raise(static_cast<VarId>(i),
                      axes | (s.op == Op::Illuminate ? global_axes(SL_VAR_Ps) : NoAxis));
            }
        }
    }
    for (std::size_t i = 0; i < s.bodies.size(); ++i) {
        steps_.push_back({&s, &s.bodies[i], i});
        block(s.bodies[i]);
        steps_.pop_back();
    }
    if (s.op == Op::Loop && differs(s.args[0]) != NoAxis) {
        changed_ = grow(splits_, &s, differs(s.args[0])) || changed_;
    }
}

unsigned AuxAnalysis::value_axes(const Stmt& s) const {
    if (s.op == Op::Call) {
        return call_axes(s);
    }
    unsigned axes = NoAxis;
    for_each_read(s, [&](VarId id) { axes |= differs(id); });
    return axes;
}

unsigned AuxAnalysis::call_axes(const Stmt& s) const {
    if (aux_rule(s) == AuxRule::Operator) {
        return operator_axes(s);
    }
    unsigned axes = NoAxis;
    for_each_read(s, [&](VarId id) { axes |= differs(id); });
    for (int i = 0; i < SL_VAR_COUNT; ++i) {
        axes |= (builtin_of(s).reads >> i & 1) != 0 ? global_axes(i) : NoAxis;
    }
    return axes;
}

// Derivatives are taken to be constant from point to point; lookups and steps move with their
// arguments, normals with the surface.
unsigned AuxAnalysis::operator_axes(const Stmt& s) const {
    const BuiltinRow& row = builtin_of(s);
    if (row.name == "calculatenormal") {
        return global_axes(SL_VAR_Ng);
    }
    unsigned axes = NoAxis;
    if (row.name == "filterstep" || row.has(PropTextures)) {
        for_each_read(s, [&](VarId id) { axes |= differs(id); });
        for (const int id : {SL_VAR_s, SL_VAR_t}) {
            axes |= (row.reads >> id & 1) != 0 ? global_axes(id) : NoAxis;
        }
    }
    return axes;
}

void AuxAnalysis::raise(VarId id, unsigned axes) {
    const Var& v = var(id);
    std::uint8_t& known = differs_[static_cast<std::size_t>(id)];
    if (v.type == Type::String || v.kind == VarKind::Const || (axes & ~known) == 0) {
        return;
    }
    known = static_cast<std::uint8_t>(known | axes);
    changed_ = true;
}

// An assignment that not all points come to makes the variable differ for whoever uses it
// elsewhere.
void AuxAnalysis::raise_assigned(VarId id, unsigned axes) {
    for (const Step& step : steps_) {
        const unsigned parted =
            step.stmt->op == Op::If ? differs(step.stmt->args[0]) : of(splits_, step.stmt);
        if (parted != NoAxis && slice_.hands_on(*step.stmt, id)) {
            axes |= parted;
        }
        const unsigned skipped = is_body(step) ? of(iterations_, step.stmt) : NoAxis;
        if (skipped != NoAxis && slice_.next_round_reads(*step.stmt, id)) {
            axes |= skipped;
        }
    }
    raise(id, axes);
}

// Where `continue` skips the rest.
bool AuxAnalysis::is_body(const Step& step) {
    return step.stmt->op == Op::Loop ? step.body == 1 : is_loop(step.stmt->op);
}

bool AuxAnalysis::is_target(const Step& step, const Stmt& jump) {
    return jump.op == Op::Leave ? step.stmt->op == Op::Scope : is_loop(step.stmt->op);
}

unsigned AuxAnalysis::of(const std::unordered_map<const Stmt*, unsigned>& set, const Stmt* s) {
    const auto it = set.find(s);
    return it == set.end() ? NoAxis : it->second;
}

bool AuxAnalysis::grow(std::unordered_map<const Stmt*, unsigned>& set, const Stmt* s,
                       unsigned axes) const {
    unsigned& known = set[s];
    const bool grows = (axes & ~known) != 0;
    known |= axes;
    return grows;
}

// Points that left something on the way are not here: whatever the jump crosses, and its target,
// they leave at different times.
void AuxAnalysis::jump(const Stmt& s) {
    unsigned parted = NoAxis;
    int levels = s.levels;
    for (auto step = steps_.rbegin(); step != steps_.rend(); ++step) {
        const Stmt* at = step->stmt;
        if (at->op == Op::If) {
            parted |= differs(at->args[0]);
            continue;
        }
        const bool is_end = is_target(*step, s) && --levels == 0;
        const bool continues = is_end && s.op == Op::Continue;
        parted |= is_body(*step) ? of(iterations_, at) : NoAxis;
        parted |= continues ? NoAxis : of(splits_, at);
        if (parted != NoAxis && (is_loop(at->op) || at->op == Op::Scope)) {
            changed_ = grow(continues ? iterations_ : splits_, at, parted) || changed_;
        }
        if (is_end) {
            break;
        }
    }
    if (parted != NoAxis) {
        mark_losing(s);
    }
}

void AuxAnalysis::mark_losing(const Stmt& s) {
    losing_.insert(&s);
    int levels = s.levels;
    for (auto step = steps_.rbegin(); step != steps_.rend(); ++step) {
        if (is_target(*step, s) && --levels == 0) {
            return;
        }
        losing_.insert(step->stmt);
    }
}

} // namespace slc
