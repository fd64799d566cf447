// SPDX-License-Identifier: Apache-2.0
// Calls that wait for rays. In: a suspension point with what must outlive it (suspension.h). Out:
// the question goes to the frame, live values, masks and the states of loops around go there too,
// the function returns; entered again it jumps behind that, takes everything back and reads the
// answer. Declarations that the jump passes over are either restored or dead. The frame holds one
// record per point in a union: a packet waits at one point at a time.
#include "slc/builtins.h"
#include "slc/emit_call.h"
#include "slc/ir_util.h"

#include <algorithm>

namespace slc {

namespace {

constexpr std::string_view frame_head = "frame->";

std::string point_name(int state) {
    return "at_" + std::to_string(state);
}

bool uses_random(const Block& b) {
    return std::ranges::any_of(b, [](const Stmt& s) {
        return (s.op == Op::Call && builtin_of(s).has(PropRandom)) ||
               std::ranges::any_of(s.bodies, uses_random);
    });
}

} // namespace

void Emitter::wait_at(const Suspensions& points) {
    waits_ = &points;
    keeps_counters_ = uses_random(body_);
}

bool Emitter::waits(const Stmt& s) const {
    return waits_ != nullptr && mode_ == Mode::Shade && waits_->state(s) != 0;
}

// What the emitted code itself has in the blocks around: masks of the blocks, of arms that are yet
// to run, of loops; the lights of illuminance loops.
std::vector<Emitter::Kept> Emitter::control_state(const Block& b) const {
    std::vector<Kept> kept;
    const auto add = [&](const std::string& name, bool is_light_loop) {
        const bool known = std::ranges::any_of(kept, [&](const Kept& k) { return k.name == name; });
        if (!known) {
            kept.push_back({name, is_light_loop});
        }
    };
    for (const Block* at = &b; at != nullptr; at = flow_.block(*at).parent) {
        add(mask(*at), false);
        const Stmt* owner = flow_.block(*at).owner;
        if (owner == nullptr) {
            continue;
        }
        const bool parts = owner->op == Op::If && varying(owner->args[0]);
        if (parts && owner->bodies.size() > 1 && at == owner->bodies.data() &&
            !owner->bodies[1].empty()) {
            add(masks_.at(&owner->bodies[1]), false);
        } else if (owner->op == Op::Loop && flow_.construct(*owner).masked) {
            add(stems_.at(owner), false);
        } else if (owner->op == Op::Illuminance) {
            add(stems_.at(owner), true);
        }
    }
    return kept;
}

// Values sent to lights lie on the stack: named again after a suspension.
void Emitter::send_again(const Block& b) {
    for (const Block* at = &b; at != nullptr; at = flow_.block(*at).parent) {
        const Stmt* owner = flow_.block(*at).owner;
        if (owner != nullptr && owner->op == Op::Illuminance) {
            light_sends(*owner, stems_.at(owner));
        }
    }
}

void Emitter::save_and_restore(const SuspensionPoint& point, const Block& b, bool restores) {
    const int state = waits_->state(*point.call);
    const std::string record = std::string(frame_head) + "saved." + point_name(state) + ".";
    const std::string kept = std::string(frame_head) + "kept.";
    const auto move = [&](const std::string& mine, const std::string& saved) {
        out_.line((restores ? mine + " = " + saved : saved + " = " + mine) + ";");
    };
    for (const Kept& k : control_state(b)) {
        if (k.is_light_loop) {
            out_.line(std::string(restores ? "sl_lights_restore(&" : "sl_lights_save(&") + k.name +
                      ", &" + record + k.name + ");");
        } else {
            move(k.name, record + k.name);
        }
    }
    for (const VarId v : point.saved) {
        const std::string& name = names_[static_cast<std::size_t>(v)];
        if (var(v).array_length > 0) {
            const std::string& to = restores ? name : record + name;
            const std::string& from = restores ? record + name : name;
            out_.line("__builtin_memcpy(" + to + ", " + from + ", sizeof " + record + name + ");");
        } else {
            move(name, record + name);
        }
    }
    if (!counted_.empty()) {
        move("sl_steps", kept + "steps_left");
        move("call->steps", kept + "steps");
    }
    if (keeps_counters_) {
        move("call->own_counters", kept + "counters");
    }
    if (checked_) {
        move("call->checked", kept + "checked");
    }
}

// The members of a point's record, for the frame's declaration.
void Emitter::declare_record(const SuspensionPoint& point, const Block& b) {
    records_.open("struct {");
    for (const Kept& k : control_state(b)) {
        records_.line((k.is_light_loop ? "sl_saved_lights" : std::string(dialect_.varying_truth)) +
                      " " + k.name + ";");
    }
    for (const VarId v : point.saved) {
        records_.line(declarator(v, false) + ";");
    }
    records_.close("} " + point_name(waits_->state(*point.call)) + ";");
}

void Emitter::declare_frame(Lines& out) const {
    out.open("struct frame {");
    out.line("sl_frame head;");
    out.open("struct {");
    if (!counted_.empty()) {
        out.line("int steps_left;");
        out.line("uint32_t steps;");
    }
    if (keeps_counters_) {
        out.line("sl_counters counters;");
    }
    if (checked_) {
        out.line(std::string(dialect_.varying_truth) + " checked;");
    }
    out.close("} kept;");
    out.open("union {");
    out.append(records_);
    out.close("} saved;");
    out.close("};");
    out.line("");
}

void Emitter::resume_switch() {
    if (waits_ == nullptr || waits_->empty()) {
        return;
    }
    out_.open("switch (frame->head.state) {");
    for (std::size_t i = 1; i <= waits_->points().size(); ++i) {
        out_.line("case " + std::to_string(i) + ": goto resume_" + std::to_string(i) + ";");
    }
    out_.line("default: break;");
    out_.close();
}

// The inputs of the call as the question takes them.
void Emitter::question(Call& c) {
    for (std::size_t r = 0; r < c.row.args.size(); ++r) {
        const ArgSpec& spec = c.row.args[r];
        if (spec.is_output) {
            continue;
        }
        const VarId v = c.s.args[arg_position(c.row, r)];
        const Form wanted =
            spec.kind == ArgKind::Exact ? form_of(spec.type) : form_of(Type::Vector);
        c.arguments.push_back(var(v).type == Type::String ? as_uniform(use(v), c.b).text
                                                          : fit(use(v), wanted, true).text);
    }
    if (c.row.takes_pairs) {
        value_arguments(c, c.row.args.size() + (c.row.has(PropChannel) ? 1 : 0));
    }
    output_pairs(c);
}

void Emitter::waiting_call(const Stmt& s, const Block& b) {
    const BuiltinRow& row = builtin_of(s);
    const int state = waits_->state(s);
    const SuspensionPoint& point = waits_->points()[static_cast<std::size_t>(state) - 1];
    const std::string body = "slv_" + std::string(row.body);
    const std::string query = "&frame->head.rays";
    Call ask{s, b, row, true, s.args.size(), ""};
    ask.mask = mask(b);
    ask.arguments = {"call", ask.mask, query};
    refresh_planes(row.reads, b);
    question(ask);
    settle_all();
    declare_record(point, b);
    note_place(s.loc);
    out_.open("if (sl_any(" + ask.mask + ")) {");
    out_.line(body + "_ask(" + joined(ask.arguments) + ");");
    save_and_restore(point, b, false);
    out_.line("frame->head.state = " + std::to_string(state) + ";");
    if (places_ != nullptr) {
        out_.line("sl_profile_at(profile, 0, live);");
    }
    out_.line("return SL_SUSPENDED;");
    out_.line("resume_" + std::to_string(state) + ":;");
    save_and_restore(point, b, true);
    send_again(b);
    if (places_ != nullptr) {
        stamp(s.loc);
    }
    out_.close();
    Call answer{s, b, row, true, s.args.size(), ""};
    answer.mask = mask(b);
    answer.arguments = {"call", answer.mask, query};
    for (std::size_t r = 0; r < row.args.size(); ++r) {
        if (row.args[r].is_output) {
            output_argument(answer, s.args[arg_position(row, r)]);
        }
    }
    output_pairs(answer);
    Expr value;
    value.varying = true;
    value.form = form_of(row.result.kind == ArgKind::Exact ? row.result.type : Type::Vector);
    value.text = body + "_answer(" + joined(answer.arguments) + ")";
    finish_call(answer, value);
}

} // namespace slc
