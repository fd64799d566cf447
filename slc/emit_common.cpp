// SPDX-License-Identifier: Apache-2.0
// Declarations, assignment, and the deferral of temporaries: a temporary that is read once and
// whose operands do not change before that is not stored but written where it is used, so that the
// text reads like the source.
#include "slc/emit_common.h"

#include "slc/builtins.h"

#include <algorithm>

namespace slc {

namespace {

// Longer expressions get a variable of their own.
constexpr std::size_t max_deferred_text = 110;

bool is_condition(Op op) {
    return op >= Op::Eq && op <= Op::Not;
}

bool has_value_only(Op op) {
    return op <= Op::Load && op != Op::Store;
}

} // namespace

Emitter::Emitter(const Program& program, const Block& body, std::uint64_t results, Mode mode,
                 const Dialect& dialect, const std::vector<std::string>& names, StringPool& strings,
                 Lines& out, std::string label_suffix)
    : program_(program), body_(body), results_(results), mode_(mode), dialect_(dialect),
      names_(names), strings_(strings), out_(out), label_suffix_(std::move(label_suffix)),
      flow_(program, body, results, mode == Mode::Init), counted_(program, body) {
    find_truths(body);
}

// Temporaries that hold conditions stay masks (or ints) and never become 0 and 1.
void Emitter::find_truths(const Block& b) {
    for (const Stmt& s : b) {
        if (is_condition(s.op) && var(s.dst).kind == VarKind::Temp &&
            flow_.place(s.dst).num_writes == 1 && flow_.place(s.dst).set_first) {
            truths_.insert(s.dst);
        }
        for (const Block& inner : s.bodies) {
            find_truths(inner);
        }
    }
}

void Emitter::emit_body() {
    masks_[&body_] = "live";
    declare_at_top();
    if (!counted_.empty()) {
        out_.line(std::string(dialect_.uniform_truth) + " sl_steps = SL_STEPS_AT_ONCE;");
    }
    resume_switch();
    check_inputs();
    block(body_);
    place_label("stopped" + label_suffix_);
    if (mode_ == Mode::Shade) {
        store_results();
    }
}

void Emitter::declare_at_top() {
    for (std::size_t i = 0; i < program_.vars.size(); ++i) {
        const auto v = static_cast<VarId>(i);
        const VarPlace& place = flow_.place(v);
        if (!place.home || place.set_first) {
            continue;
        }
        if (var(v).aux != 0) {
            load_aux(v);
            declared_.insert(v);
            continue;
        }
        switch (var(v).kind) {
        case VarKind::Global:
            load_global(v);
            break;
        case VarKind::Param:
            if (mode_ == Mode::Shade) { // defaults are written where they lie
                load_param(v);
            }
            break;
        case VarKind::Local:
        case VarKind::Temp:
            out_.line(declarator(v, false) + " = " + zero(v) + ";");
            break;
        case VarKind::Const:
            break; // arrays are declared with the object's other constants
        }
        declared_.insert(v);
    }
}

// Differences at the auxiliary points; 0 where the engine has none.
void Emitter::load_aux(VarId v) {
    const Var& variable = var(v);
    const std::string points = variable.aux == 1 ? "batch->aux_u" : "batch->aux_v";
    const std::string suffix(form_suffix(form(v)));
    if (variable.kind == VarKind::Global) {
        out_.line(declarator(v, !flow_.place(v).is_written) + " = slv_aux_" + suffix + "(call, " +
                  points + ", SL_VAR_" +
                  std::string(variable_rows()[static_cast<std::size_t>(variable.index)].name) +
                  ");");
        return;
    }
    const auto param =
        static_cast<std::size_t>(program_.params[static_cast<std::size_t>(variable.index)].var);
    const int n = num_components(variable.type), length = std::max(variable.array_length, 1);
    const std::string base =
        "params->" + names_[param] + " + " + std::to_string(variable.aux * n * length);
    if (variable.array_length == 0) {
        out_.line(declarator(v, !flow_.place(v).is_written) + " = sl_load_" + suffix + "(call, " +
                  base + " * batch->stride);");
        return;
    }
    const std::string& name = names_[static_cast<std::size_t>(v)];
    out_.line(declarator(v, false) + ";");
    out_.line("for (int k = 0; k < " + std::to_string(length) + "; k++)");
    out_.line("    " + name + "[k] = sl_load_" + suffix + "(call, params->" + names_[param] +
              " + (" + std::to_string(variable.aux * n * length) + " + k * " + std::to_string(n) +
              ") * batch->stride);");
}

void Emitter::store_aux(VarId v) {
    const Var& variable = var(v);
    if (variable.kind == VarKind::Global && program_.shader_type == SL_SHADER_displacement) {
        out_.line("sl_store_aux_" + std::string(form_suffix(form(v))) + "(call, " +
                  (variable.aux == 1 ? "batch->aux_u" : "batch->aux_v") + ", SL_VAR_" +
                  std::string(variable_rows()[static_cast<std::size_t>(variable.index)].name) +
                  ", " + names_[static_cast<std::size_t>(v)] + ");");
    }
}

void Emitter::load_global(VarId v) {
    const bool is_result = (results_ >> var(v).index & 1U) != 0;
    const VarPlace& place = flow_.place(v);
    const bool in_light_loop =
        program_.shader_type != SL_SHADER_light &&
        (var(v).index == SL_VAR_L || var(v).index == SL_VAR_Cl || var(v).index == SL_VAR_Ol);
    if (in_light_loop && !is_result) {
        // Exists only inside illuminance; zero elsewhere.
        out_.line(declarator(v, false) + " = " + zero(v) + ";");
        return;
    }
    const Form f = form(v);
    const std::string name =
        "SL_VAR_" + std::string(variable_rows()[static_cast<std::size_t>(var(v).index)].name);
    std::string value = varying(v) ? "slv_var_" : "slu_var_";
    value += std::string(form_suffix(f)) + "(call, " + name + ")";
    out_.line(declarator(v, !place.is_written) + " = " + value + ";");
}

void Emitter::load_param(VarId v) {
    const Var& p = var(v);
    const std::string& name = names_[static_cast<std::size_t>(v)];
    const VarPlace& place = flow_.place(v);
    const std::string suffix(form_suffix(form(v)));
    if (!varying(v)) {
        if (p.array_length > 0) {
            out_.line(std::string(place.is_written ? "" : "const ") +
                      std::string(type_word(form(v), false)) + " *const " + name + " = params->" +
                      name + ";");
        } else {
            out_.line(declarator(v, !place.is_written) + " = params->" + name + ";");
        }
        return;
    }
    if (p.array_length == 0) {
        out_.line(declarator(v, !place.is_written) + " = sl_load_" + suffix + "(call, params->" +
                  name + ");");
        return;
    }
    out_.line(declarator(v, false) + ";");
    out_.line("for (int sl_k = 0; sl_k < " + std::to_string(p.array_length) + "; sl_k++)");
    out_.line("    " + name + "[sl_k] = sl_load_" + suffix + "(call, params->" + name +
              " + sl_k * " + std::to_string(num_components(p.type)) + " * batch->stride);");
}

void Emitter::store_results() {
    for (std::size_t i = 0; i < program_.vars.size(); ++i) {
        const auto v = static_cast<VarId>(i);
        const Var& variable = var(v);
        if (!flow_.place(v).is_written) {
            continue;
        }
        if (variable.aux != 0) {
            store_aux(v);
        } else if (variable.kind == VarKind::Param) {
            store_param(v, "live");
        } else if (variable.kind == VarKind::Global && (results_ >> variable.index & 1U) != 0) {
            out_.line("sl_store_" + std::string(form_suffix(form(v))) +
                      "(call, live, batch->main->var[SL_VAR_" +
                      std::string(variable_rows()[static_cast<std::size_t>(variable.index)].name) +
                      "], " + names_[i] + ");");
        }
    }
}

void Emitter::store_param(VarId v, const std::string& lanes) {
    const Var& p = var(v);
    const std::string& name = names_[static_cast<std::size_t>(v)];
    const std::string suffix(form_suffix(form(v)));
    if (!varying(v)) {
        if (p.array_length == 0) {
            out_.line("params->" + name + " = " + name + ";");
        }
        return; // arrays were written in place
    }
    if (p.array_length == 0) {
        out_.line("sl_store_" + suffix + "(call, " + lanes + ", params->" + name + ", " + name +
                  ");");
        return;
    }
    out_.line("for (int sl_k = 0; sl_k < " + std::to_string(p.array_length) + "; sl_k++)");
    out_.line("    sl_store_" + suffix + "(call, " + lanes + ", params->" + name + " + sl_k * " +
              std::to_string(num_components(p.type)) + " * batch->stride, " + name + "[sl_k]);");
}

void Emitter::assign(VarId dst, const Expr& value, const Block& b) {
    settle_readers(dst);
    const VarPlace& place = flow_.place(dst);
    Expr e = value;
    if (is_truth(dst)) {
        e = varying(dst) ? as_varying(as_truth(std::move(e))) : as_truth(std::move(e));
    } else {
        e = fit(std::move(e), form(dst), varying(dst));
        if (!varying(dst)) {
            e = as_uniform(std::move(e), b);
        }
    }
    const Expr name = name_of(dst);
    const bool in_memory = mode_ == Mode::Init && var(dst).kind == VarKind::Param;
    if (!in_memory && place.set_first && place.home == &b && declared_.insert(dst).second) {
        out_.line(declarator(dst, place.num_writes == 1) + " = " + e.text + ";");
    } else if (varying(dst) && flow_.must_blend(dst, b)) {
        out_.line(name.text + " = slv_select_" + std::string(form_suffix(form(dst))) + "(" +
                  mask(b) + ", " + e.text + ", " + name.text + ");");
    } else {
        out_.line(name.text + " = " + e.text + ";");
    }
}

bool Emitter::may_defer(const Stmt& s, const Block& b) const {
    if (checked_ || s.dst == no_var || var(s.dst).kind != VarKind::Temp ||
        var(s.dst).array_length > 0) {
        return false;
    }
    const VarPlace& place = flow_.place(s.dst);
    if (place.num_writes != 1 || place.num_reads != 1 || !place.set_first ||
        flow_.must_blend(s.dst, b)) {
        return false;
    }
    if (s.op == Op::Call || s.op == Op::Difference) {
        const BuiltinRow& row = builtin_rows()[static_cast<std::size_t>(s.builtin)];
        return row.has(PropPure) && !row.repeats_last && !row.takes_pairs && !row.takes_values;
    }
    return has_value_only(s.op);
}

void Emitter::defer(VarId dst, Expr value) {
    if (is_truth(dst)) {
        value = varying(dst) ? as_varying(as_truth(std::move(value))) : as_truth(std::move(value));
    } else {
        value = fit(std::move(value), form(dst), varying(dst));
    }
    deferred_.push_back({dst, std::move(value), reading_});
    if (deferred_.back().value.text.size() > max_deferred_text) {
        settle(dst);
    }
}

void Emitter::settle(VarId v) {
    const auto it = std::find_if(deferred_.begin(), deferred_.end(),
                                 [&](const Deferred& d) { return d.var == v; });
    if (it == deferred_.end()) {
        return;
    }
    const Deferred d = std::move(*it);
    deferred_.erase(it);
    declared_.insert(v);
    out_.line(declarator(v, true) + " = " + d.value.text + ";");
}

void Emitter::settle_all() {
    while (!deferred_.empty()) {
        settle(deferred_.front().var);
    }
}

void Emitter::settle_readers(VarId written) {
    for (std::size_t i = 0; i < deferred_.size();) {
        const std::vector<VarId>& reads = deferred_[i].reads;
        if (std::find(reads.begin(), reads.end(), written) != reads.end()) {
            settle(deferred_[i].var);
        } else {
            ++i;
        }
    }
}

} // namespace slc
