// SPDX-License-Identifier: Apache-2.0
// Statements and control flow. Control that all lanes share stays C control; where lanes part, an
// arm runs under its own mask if any lane is in it, and a masked exit takes the lanes that leave
// out of every mask up to its target.
#include "slc/builtins.h"
#include "slc/emit_common.h"
#include "slc/ir_util.h"

#include <algorithm>

namespace slc {

std::string Emitter::fresh(std::string_view stem) {
    std::string name(stem);
    return name + "_" + std::to_string(++counters_[name]) + label_suffix_;
}

// `#line` in front of the first statement from a source line: compiler messages, debuggers and
// profiles show SL.
void Emitter::note_place(const Loc& loc) {
    if (loc.line == 0 || (loc.line == place_line_ && loc.file == place_file_)) {
        return;
    }
    place_line_ = loc.line;
    place_file_ = loc.file;
    const std::string file = loc.file < program_.files.size() ? program_.files[loc.file] : "?";
    out_.raw("#line " + std::to_string(loc.line) + " " + c_string(file));
    if (places_ != nullptr && stamped_block_ != nullptr) {
        stamp(loc);
    }
}

// Control comes here from several places: a profile wants a stamp.
void Emitter::forget_place() {
    place_line_ = places_ != nullptr ? 0 : place_line_;
}

void Emitter::stamp(const Loc& loc) {
    const auto it = std::find_if(places_->begin(), places_->end(), [&](const Loc& place) {
        return place.line == loc.line && place.file == loc.file;
    });
    const auto row = it - places_->begin();
    if (it == places_->end()) {
        places_->push_back(loc);
    }
    out_.line("sl_profile_at(profile, " + std::to_string(row) + ", " + mask(*stamped_block_) +
              ");");
}

void Emitter::place_label(const std::string& label) {
    if (labels_used_.count(label) > 0) {
        settle_all();
        out_.line(label + ":;");
    }
}

void Emitter::block(const Block& b) {
    std::string end;
    forget_place();
    for (std::size_t i = 0; i < b.size(); ++i) {
        statement(b[i], b);
        const bool more = i + 1 < b.size();
        const bool may_stop = mode_ == Mode::Shade && counted_.may_stop(b[i]);
        if (more && (flow_.loses_lanes(b[i]) || may_stop)) {
            settle_all();
            if (end.empty()) {
                end = fresh("end");
                labels_used_.insert(end);
            }
            out_.line("if (!sl_any(" + mask(b) + ")) goto " + end + ";");
        }
    }
    settle_all();
    if (!end.empty()) {
        place_label(end);
    }
    forget_place();
}

void Emitter::statement(const Stmt& s, const Block& b) {
    reading_.clear();
    stamped_block_ = &b;
    switch (s.op) {
    case Op::Call:
    case Op::Difference:
        call(s, b);
        for_each_write(s, [&](VarId v, bool) { check_value(v, s, b); });
        return;
    case Op::Store:
        store_element(s, b);
        return;
    case Op::If:
        branch(s, b);
        return;
    case Op::Loop:
        loop(s, b);
        return;
    case Op::Break:
    case Op::Continue:
    case Op::Leave:
        leave(s, b);
        return;
    case Op::Scope:
        scope(s, b);
        return;
    case Op::Illuminance:
        illuminance(s, b);
        return;
    case Op::Illuminate:
    case Op::Solar:
        illuminate(s, b);
        return;
    default:
        break;
    }
    if (s.op == Op::Copy && var(s.dst).array_length > 0) {
        copy_array(s, b);
        return;
    }
    const std::string zeros = zero_divisors(s);
    Expr value = value_of(s, b);
    if (may_defer(s, b)) {
        defer(s.dst, std::move(value));
        return;
    }
    note_place(s.loc);
    assign(s.dst, value, b);
    check_value(s.dst, s, b, zeros);
}

void Emitter::store_element(const Stmt& s, const Block& b) {
    const VarId array = s.dst;
    settle_readers(array);
    const Expr index = index_of(s.args[0], std::max(var(array).array_length, 1));
    const Expr value = fit(use(s.args[1]), form(array), varying(array));
    const std::string suffix(form_suffix(form(array)));
    const std::string name = name_of(array).text;
    note_place(s.loc);
    if (index.varying) {
        out_.line("slv_put_" + suffix + "(" + name + ", " + index.text + ", " + mask(b) + ", " +
                  value.text + ");");
        return;
    }
    const std::string element = name + "[" + index.text + "]";
    if (varying(array) && flow_.must_blend(array, b)) {
        out_.line(element + " = slv_select_" + suffix + "(" + mask(b) + ", " + value.text + ", " +
                  element + ");");
    } else {
        out_.line(element + " = " + value.text + ";");
    }
}

// An array from an array of the same length, or every element from one value.
void Emitter::copy_array(const Stmt& s, const Block& b) {
    const VarId array = s.dst;
    const VarId source = s.args[0];
    settle_readers(array);
    note_place(s.loc);
    Expr value = use(source);
    if (var(source).array_length > 0) {
        value.text += "[sl_k]";
    }
    value = fit(std::move(value), form(array), varying(array));
    const std::string name = name_of(array).text;
    const VarPlace& place = flow_.place(array);
    const bool in_memory = var(array).kind == VarKind::Param;
    if (!in_memory && place.set_first && place.home == &b && declared_.insert(array).second) {
        out_.line(declarator(array, false) + ";");
    }
    if (varying(array) && flow_.must_blend(array, b)) {
        value.text = "slv_select_" + std::string(form_suffix(form(array))) + "(" + mask(b) + ", " +
                     value.text + ", " + name + "[sl_k])";
    }
    out_.line("for (int sl_k = 0; sl_k < " + std::to_string(var(array).array_length) + "; sl_k++)");
    out_.line("    " + name + "[sl_k] = " + value.text + ";");
}

void Emitter::branch(const Stmt& s, const Block& b) {
    const Block& then_arm = s.bodies[0];
    static const Block nothing;
    const Block& else_arm = s.bodies.size() > 1 ? s.bodies[1] : nothing;
    Expr condition = as_truth(use(s.args[0]));
    settle_all();
    note_place(s.loc);
    if (!condition.varying) {
        masks_[&then_arm] = mask(b);
        masks_[&else_arm] = mask(b);
        out_.open("if (" + condition.text + ") {");
        block(then_arm);
        if (!else_arm.empty()) {
            out_.turn("} else {");
            block(else_arm);
        }
        out_.close();
        return;
    }
    // Both masks before either arm: an exit in the first narrows the mask around them.
    const std::string yes = fresh("mask");
    const std::string no = else_arm.empty() ? "" : fresh("mask");
    const std::string lanes(dialect_.varying_truth);
    masks_[&then_arm] = yes;
    out_.line(lanes + " " + yes + " = " + mask(b) + " & " + wrap(condition, Prec::Compare, true) +
              ";");
    if (!else_arm.empty()) {
        masks_[&else_arm] = no;
        out_.line(lanes + " " + no + " = " + mask(b) + " & ~" + yes + ";");
    }
    out_.open("if (sl_any(" + yes + ")) {");
    block(then_arm);
    out_.close();
    if (!else_arm.empty()) {
        out_.open("if (sl_any(" + no + ")) {");
        block(else_arm);
        out_.close();
    }
}

void Emitter::loop(const Stmt& s, const Block& b) {
    settle_all();
    note_place(s.loc);
    stems_[&s] = fresh("loop");
    jumpable_.push_back(&s);
    if (flow_.construct(s).masked) {
        masked_loop(s, b);
    } else {
        uniform_loop(s, b);
    }
    jumpable_.pop_back();
    place_label("done_" + stems_[&s]);
}

void Emitter::uniform_loop(const Stmt& s, const Block& b) {
    for (const Block& inner : s.bodies) {
        masks_[&inner] = mask(b);
    }
    out_.open("for (;;) {");
    forget_place();
    // The condition's last temporary is still deferred: it becomes the test.
    for (const Stmt& c : s.bodies[0]) {
        statement(c, s.bodies[0]);
    }
    reading_.clear();
    const Expr condition = as_truth(use(s.args[0]));
    settle_all();
    out_.line("if (!" + wrap(condition, Prec::Atom) + ") break;");
    block(s.bodies[1]);
    place_label("next_" + stems_[&s]);
    block(s.bodies[2]);
    count_step(s, b, mask(b));
    out_.close();
}

void Emitter::masked_loop(const Stmt& s, const Block& b) {
    const std::string& lanes = stems_[&s];
    const std::string type(dialect_.varying_truth);
    masks_[&s.bodies[0]] = lanes;
    masks_[&s.bodies[2]] = lanes;
    out_.line(type + " " + lanes + " = " + mask(b) + "; /* lanes still in the loop */");
    out_.open("for (;;) {");
    forget_place();
    for (const Stmt& c : s.bodies[0]) {
        statement(c, s.bodies[0]);
    }
    reading_.clear();
    const Expr condition = as_truth(use(s.args[0]));
    settle_all();
    if (condition.varying) {
        out_.line(lanes + " &= " + condition.text + ";");
    } else {
        out_.line("if (!" + wrap(condition, Prec::Atom) + ") break;");
    }
    out_.line("if (!sl_any(" + lanes + ")) break;");
    if (flow_.construct(s).has_masked_continue) {
        const std::string iteration = fresh("iteration");
        masks_[&s.bodies[1]] = iteration;
        out_.line(type + " " + iteration + " = " + lanes + ";");
    } else {
        masks_[&s.bodies[1]] = lanes;
    }
    block(s.bodies[1]);
    place_label("next_" + stems_[&s]);
    block(s.bodies[2]);
    count_step(s, b, lanes);
    out_.close();
}

// At a loop's back edge. Lanes that used up their iterations leave every mask: their results stay
// what they were. `running`: the mask of the lanes in the loop.
void Emitter::count_step(const Stmt& s, const Block& b, const std::string& running) {
    if (!counted_.counts(s)) {
        return;
    }
    const bool is_uniform = running == mask(b);
    const auto may_stop = [&](const Stmt& inner) { return counted_.may_stop(inner); };
    const bool holds_counted =
        std::any_of(s.bodies.begin(), s.bodies.end(),
                    [&](const Block& body) { return std::ranges::any_of(body, may_stop); });
    if (mode_ == Mode::Shade && is_uniform && holds_counted) {
        out_.line("if (!sl_any(" + running + ")) break; /* stopped inside */");
    }
    const std::string file = s.loc.file < program_.files.size() ? program_.files[s.loc.file] : "?";
    const std::string lanes = mode_ == Mode::Shade ? running : "call->live";
    out_.open("if (--sl_steps < 0 && (sl_steps = sl_more_steps(call, " + lanes + ", " +
              c_string(file) + ", " + std::to_string(s.loc.line) + ")) == 0) {");
    if (mode_ == Mode::Shade) {
        for (const std::string& name : masks_around(b, running)) {
            out_.line(name + " &= ~" + running + ";");
        }
        out_.line(running + " = (" + std::string(dialect_.varying_truth) + "){0};");
        out_.line("break;");
    } else {
        labels_used_.insert("stopped" + label_suffix_);
        out_.line("goto stopped" + label_suffix_ + ";");
    }
    out_.close();
}

// Every mask that holds lanes of a block, from the inside out, but one.
std::vector<std::string> Emitter::masks_around(const Block& b, const std::string& but) const {
    std::vector<std::string> masks;
    const auto add = [&](const std::string& name) {
        if (name != but && std::find(masks.begin(), masks.end(), name) == masks.end()) {
            masks.push_back(name);
        }
    };
    for (const Block* at = &b; at != nullptr; at = flow_.block(*at).parent) {
        add(mask(*at));
        const Stmt* owner = flow_.block(*at).owner;
        if (owner != nullptr && owner->op == Op::Loop && flow_.construct(*owner).masked) {
            add(stems_.at(owner));
        } else if (owner != nullptr && owner->op == Op::Illuminance) {
            add(stems_.at(owner) + ".live");
        }
    }
    return masks;
}

void Emitter::scope(const Stmt& s, const Block& b) {
    settle_all();
    stems_[&s] = fresh("scope");
    const Block& body = s.bodies[0];
    if (flow_.construct(s).masked) {
        masks_[&body] = stems_[&s];
        out_.line(std::string(dialect_.varying_truth) + " " + stems_[&s] + " = " + mask(b) + ";");
    } else {
        masks_[&body] = mask(b);
    }
    out_.open("{");
    block(body);
    out_.close();
    place_label("done_" + stems_[&s]);
}

void Emitter::illuminance(const Stmt& s, const Block& b) {
    const std::string lights = fresh("lights");
    const std::string lit = fresh("lit");
    const Block& body = s.bodies[0];
    stems_[&s] = lights;
    masks_[&body] = lit;
    const std::string category =
        s.category == no_var ? string_literal("") : as_uniform(use(s.category), b).text;
    std::string arguments = "(call, &" + lights + ", " + mask(b) + ", " +
                            fit(use(s.args[0]), Form::Triple, true).text + ", ";
    const bool has_cone = s.args.size() >= 3;
    if (has_cone) {
        arguments += fit(use(s.args[1]), Form::Triple, true).text + ", ";
        arguments += fit(use(s.args[2]), Form::Float, true).text + ", ";
    }
    settle_all();
    store_outputs(b);
    note_place(s.loc);
    out_.line("sl_light_loop " + lights + ";");
    out_.line((has_cone ? "sl_lights_begin_cone" : "sl_lights_begin") + arguments + category +
              ");");
    light_options(s, lights);
    out_.open("for (" + std::string(dialect_.varying_truth) + " " + lit +
              "; sl_lights_next(call, &" + lights + ", &" + lit + ");) {");
    jumpable_.push_back(&s);
    static constexpr struct {
        sl_variable id;
        std::string_view field;
    } samples[] = {{SL_VAR_L, ".L"}, {SL_VAR_Cl, ".Cl"}, {SL_VAR_Ol, ".Ol"}};
    for (const auto& sample : samples) {
        const VarId v = flow_.global(sample.id);
        if (v != no_var && flow_.place(v).is_read) {
            Expr value;
            value.text = lights + std::string(sample.field);
            value.form = Form::Triple;
            value.varying = true;
            assign(v, value, body);
        }
    }
    for (const auto& [option, v] : s.options) {
        if (option.starts_with("light:")) {
            out_.line("call->lights = &" + lights + ";");
            out_.line("slv_message_lightsource(call, " + lit + ", " +
                      string_literal(option.substr(6)) + ", &" + typed_value(v) + ");");
        }
    }
    block(body);
    jumpable_.pop_back();
    out_.close();
    place_label("done_" + stems_[&s]);
}

// "lightcache" and what goes to the lights, before the loop.
void Emitter::light_options(const Stmt& s, const std::string& lights) {
    for (const auto& [option, v] : s.options) {
        if (option == "lightcache" && var(v).type == Type::String) {
            Expr mode = use(v);
            mode = mode.varying ? apply("lane_s", Form::String, true, {mode.text, "0"}) : mode;
            out_.line(lights + ".refresh = " + mode.text + " == " + string_literal("refresh") +
                      ";");
        }
    }
    light_sends(s, lights);
}

void Emitter::light_sends(const Stmt& s, const std::string& lights) {
    std::string sends;
    std::size_t num_sends = 0;
    for (const auto& [option, v] : s.options) {
        if (option.starts_with("send:light:")) {
            sends += (num_sends > 0 ? ", " : "") +
                     std::string("{SL_TYPE_string, 0, 0, (sl_string[]){") +
                     string_literal(option.substr(11)) + "}}, " +
                     typed_value(v).substr(std::string("(sl_value)").size());
            num_sends += 2;
        }
    }
    if (num_sends > 0) {
        out_.line(lights + ".sends = (sl_value[]){" + sends + "};");
        out_.line(lights + ".num_sends = " + std::to_string(num_sends) + ";");
    }
}

// The innermost illuminance around a statement: what lightsource() is about.
std::string Emitter::lights_around(const Block& b) const {
    for (const Block* at = &b; at != nullptr; at = flow_.block(*at).parent) {
        const Stmt* owner = flow_.block(*at).owner;
        if (owner != nullptr && owner->op == Op::Illuminance) {
            return "&" + stems_.at(owner);
        }
    }
    return "0";
}

void Emitter::illuminate(const Stmt& s, const Block& b) {
    const std::string lit = fresh("lit");
    const Block& body = s.bodies[0];
    masks_[&body] = lit;
    std::string function = s.op == Op::Solar ? "sl_solar" : "sl_illuminate";
    std::string arguments = "(call, " + mask(b);
    std::size_t next = 0;
    if (s.op == Op::Illuminate) {
        arguments += ", " + fit(use(s.args[next++]), Form::Triple, true).text;
    }
    const bool has_cone = s.args.size() >= next + 2;
    if (has_cone) {
        function += "_cone";
        arguments += ", " + fit(use(s.args[next]), Form::Triple, true).text;
        arguments += ", " + fit(use(s.args[next + 1]), Form::Float, true).text;
    }
    settle_all();
    note_place(s.loc);
    const std::string L = fresh("out");
    out_.line(std::string(type_word(Form::Triple, true)) + " " + L + ";");
    out_.line(std::string(dialect_.varying_truth) + " " + lit + " = " + function + arguments +
              ", &" + L + ");");
    Expr value;
    value.text = L;
    value.form = Form::Triple;
    value.varying = true;
    if (const VarId v = flow_.global(SL_VAR_L); v != no_var) {
        assign(v, value, b);
    } else if ((results_ >> SL_VAR_L & 1U) != 0) {
        out_.line("sl_store_3(call, " + mask(b) + ", batch->main->var[SL_VAR_L], " + L + ");");
    }
    if (const VarId v = flow_.global(SL_VAR_Cl); v != no_var && has_cone) {
        // Before the body: an exit inside may narrow the masks.
        const std::string name = name_of(v).text;
        out_.line(name + " = slv_select_3(" + mask(b) + " & ~" + lit +
                  ", slv_f_to_3(slv_spread_f(0.0f)), " + name + ");");
    }
    out_.open("if (sl_any(" + lit + ")) {");
    block(body);
    out_.close();
}

void Emitter::leave(const Stmt& s, const Block& b) {
    settle_all();
    note_place(s.loc);
    const ExitInfo& exit = flow_.exit(s);
    if (!exit.target) {
        return; // the verifier refuses such a program
    }
    if (exit.masked) {
        masked_leave(s, b);
    } else {
        jump(s, b);
    }
}

void Emitter::masked_leave(const Stmt& s, const Block& b) {
    const ExitInfo& exit = flow_.exit(s);
    const std::string gone = mask(b);
    std::vector<std::string> masks;
    const auto add = [&](const std::string& name) {
        if (name != gone && std::find(masks.begin(), masks.end(), name) == masks.end()) {
            masks.push_back(name);
        }
    };
    for (const Block* at = &b;; at = flow_.block(*at).parent) {
        add(mask(*at));
        const Stmt* owner = flow_.block(*at).owner;
        const bool stays = owner == exit.target && s.op == Op::Continue;
        if (owner->op == Op::Loop && !stays) {
            add(stems_[owner]);
        } else if (owner->op == Op::Illuminance && !stays) {
            add(stems_[owner] + ".live");
        }
        if (owner == exit.target) {
            break;
        }
    }
    for (const std::string& name : masks) {
        out_.line(name + " &= ~" + gone + ";");
    }
    out_.line(gone + " = (" + std::string(dialect_.varying_truth) + "){0};");
}

void Emitter::jump(const Stmt& s, const Block&) {
    const Stmt* target = flow_.exit(s).target;
    const bool innermost = !jumpable_.empty() && jumpable_.back() == target;
    if (s.op == Op::Continue && target->op == Op::Illuminance && innermost) {
        out_.line("continue;");
        return;
    }
    if (s.op == Op::Break && innermost) {
        out_.line("break;");
        return;
    }
    const std::string label = (s.op == Op::Continue ? "next_" : "done_") + stems_[target];
    labels_used_.insert(label);
    out_.line("goto " + label + ";");
}

} // namespace slc
