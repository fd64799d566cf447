// SPDX-License-Identifier: Apache-2.0
// Built-in functions that trace rays: the host answers each at once.
#include "slc/interp.h"
#include "slc/ir_util.h"

#include <algorithm>

namespace slc {

void InterpHost::rays(int, const RayQuestion& question, RayAnswer& answer) {
    if (question.kind == SL_RAYS_transmission || question.kind == SL_RAYS_shadow) {
        answer.C = {1, 1, 1};
    }
}

namespace {

constexpr double far_away = 1e30;

struct RayRow {
    std::string_view body;
    int kind;
};

constexpr RayRow ray_rows[] = {
    {"trace_c", SL_RAYS_trace},           {"trace_c_d", SL_RAYS_trace},
    {"trace_f", SL_RAYS_hittest},         {"fulltrace", SL_RAYS_fulltrace},
    {"fulltrace_d", SL_RAYS_fulltrace},   {"rayhittest", SL_RAYS_hittest},
    {"visibility", SL_RAYS_transmission}, {"transmission", SL_RAYS_transmission},
    {"occlusion", SL_RAYS_occlusion},     {"indirectdiffuse", SL_RAYS_indirect},
    {"shadow_rays_c", SL_RAYS_shadow},    {"shadow_rays_f", SL_RAYS_shadow},
    {"gather_ray", SL_RAYS_gather},       {"gather_ray_d", SL_RAYS_gather},
};

Value triple(const Triple3& t) {
    return {Type::Vector, t[0], t[1], t[2]};
}

// Outputs of the call, in the order of its row.
std::vector<Value> outputs_of(const RayRow& row, const RayQuestion& q, const RayAnswer& a) {
    const Triple3 none = {0, 0, 0};
    if (row.body == "rayhittest") {
        const Triple3 away = {q.P[0] + far_away * q.D[0], q.P[1] + far_away * q.D[1],
                              q.P[2] + far_away * q.D[2]};
        return {triple(a.hit ? a.Phit : away), triple(a.hit ? a.Nhit : none)};
    }
    if (q.kind != SL_RAYS_fulltrace) {
        return {};
    }
    const bool missed = a.level_missed > 0;
    return {triple(a.hit ? a.C : none),      Value(a.hit ? a.distance : far_away),
            triple(a.hit ? a.Phit : none),   triple(a.hit ? a.Nhit : none),
            triple(missed ? a.Pmiss : none), triple(missed ? a.Rmiss : none)};
}

Value result_of(const RayQuestion& q, const RayAnswer& a) {
    switch (q.kind) {
    case SL_RAYS_hittest:
        return Value(a.hit ? a.distance : far_away);
    case SL_RAYS_fulltrace:
        return Value(a.level_missed);
    case SL_RAYS_occlusion:
        return Value(a.C[0]);
    case SL_RAYS_gather:
        return Value(a.hit ? 1.0 : 0.0);
    case SL_RAYS_shadow:
        return triple({1 - a.C[0], 1 - a.C[1], 1 - a.C[2]});
    default:
        return triple(a.C);
    }
}

RayQuestion ray_question(const BuiltinRow& row, int kind, const std::vector<Value>& args) {
    RayQuestion q;
    q.kind = kind;
    std::size_t next = 0;
    if (kind == SL_RAYS_gather) {
        q.category = args[next++].text();
    }
    q.P = args[next++].triple();
    q.D = args[next++].triple();
    if (row.body.ends_with("_d")) {
        for (Triple3* const d : {&q.P_u, &q.D_u, &q.P_v, &q.D_v}) {
            *d = args[next++].triple();
        }
    }
    if (kind == SL_RAYS_gather) {
        q.angle = args[next].f();
        q.sample = static_cast<int>(args[next + 1].f());
    } else if (kind == SL_RAYS_occlusion || kind == SL_RAYS_indirect) {
        q.options["samples"] = args[next];
    }
    for (std::size_t i = row.args.size(); row.takes_pairs && i + 1 < args.size(); i += 2) {
        q.options[args[i].text()] = args[i + 1];
    }
    return q;
}

} // namespace

bool Interpreter::rays(const Stmt& s, int point, std::vector<Value>& args, Value& result) {
    const BuiltinRow& row = builtin_of(s);
    const auto* const known = std::find_if(std::begin(ray_rows), std::end(ray_rows),
                                           [&](const RayRow& r) { return r.body == row.body; });
    if (known == std::end(ray_rows)) {
        return false;
    }
    RayQuestion q = ray_question(row, known->kind, args);
    for (const auto& [name, id] : s.options) {
        q.wanted[name] = var(id).type;
    }
    RayAnswer answer;
    host_.rays(point, q, answer);
    for (const auto& [name, id] : s.options) {
        const auto it = answer.found.find(name);
        if (it != answer.found.end()) {
            at(id, point) = it->second;
        }
    }
    std::vector<Value> outputs = outputs_of(*known, q, answer);
    std::size_t next = 0;
    for (std::size_t i = 0; i < row.args.size(); ++i) {
        if (row.args[i].is_output) {
            args[i] = std::move(outputs[next++]);
        }
    }
    result = result_of(q, answer);
    if (row.body == "shadow_rays_f") {
        result = Value((result.at(0) + result.at(1) + result.at(2)) / 3);
    }
    return true;
}

} // namespace slc
