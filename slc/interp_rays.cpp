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
    default:
        return triple(a.C);
    }
}

} // namespace

bool Interpreter::rays(const Stmt& s, int point, std::vector<Value>& args, Value& result) {
    const BuiltinRow& row = builtin_of(s);
    const auto* const known = std::find_if(std::begin(ray_rows), std::end(ray_rows),
                                           [&](const RayRow& r) { return r.body == row.body; });
    if (known == std::end(ray_rows)) {
        return false;
    }
    RayQuestion q;
    q.kind = known->kind;
    q.P = args[0].triple();
    q.D = args[1].triple();
    if (row.body.ends_with("_d")) {
        q.P_u = args[2].triple();
        q.D_u = args[3].triple();
        q.P_v = args[4].triple();
        q.D_v = args[5].triple();
    }
    if (q.kind == SL_RAYS_occlusion || q.kind == SL_RAYS_indirect) {
        q.options["samples"] = args[2];
    }
    for (std::size_t i = row.args.size(); row.takes_pairs && i + 1 < args.size(); i += 2) {
        q.options[args[i].text()] = args[i + 1];
    }
    RayAnswer answer;
    host_.rays(point, q, answer);
    std::vector<Value> outputs = outputs_of(*known, q, answer);
    std::size_t next = 0;
    for (std::size_t i = 0; i < row.args.size(); ++i) {
        if (row.args[i].is_output) {
            args[i] = std::move(outputs[next++]);
        }
    }
    result = result_of(q, answer);
    return true;
}

} // namespace slc
