// SPDX-License-Identifier: Apache-2.0
// Maps with names that mean rays: environment("reflection", R) traces, shadow("raytrace", P) asks
// for the light that arrives, so that shaders written for maps get the effects themselves
// (docs/shading-language.md). In: a call whose arguments are lowered. Out: the call, the rays, or,
// when the name is not known before the shader runs, a branch on it.
#include "slc/ir_util.h"
#include "slc/lower.h"

namespace slc {

using ast::Expr;

const char* ray_name(const BuiltinRow& row) {
    return row.has(PropHidden)         ? nullptr
           : row.name == "environment" ? "reflection"
           : row.name == "shadow"      ? "raytrace"
                                       : nullptr;
}

VarId Lowering::map_or_rays(const Expr& e, const BuiltinRow& row, BuiltinArgs call, VarId into) {
    const std::string wanted = ray_name(row);
    const Var& name = var(call.args[0]);
    const bool is_literal = name.kind == VarKind::Const;
    const auto rays = [&] {
        return wanted == "reflection" ? reflection(row, call.args, e.loc)
                                      : traced_shadow(row, call.args, e.loc);
    };
    if (is_literal && name.text == wanted) {
        return rays();
    }
    if (is_literal) {
        const VarId dst = target(e.type, into, e.loc);
        emit(Op::Call, dst, std::move(call.args), e.loc).builtin = e.builtin;
        return dst;
    }
    const VarId result = local(std::string(row.name), e.type, 0, e.loc);
    const VarId traces = temp(Type::Float, e.loc);
    emit(Op::Eq, traces, {call.args[0], text(wanted)}, e.loc);
    Block then = block([&] { emit(Op::Copy, result, {rays()}, e.loc); });
    Block otherwise = block([&] { emit(Op::Call, result, call.args, e.loc).builtin = e.builtin; });
    Stmt& branch = emit(Op::If, no_var, {traces}, e.loc);
    branch.bodies.push_back(std::move(then));
    branch.bodies.push_back(std::move(otherwise));
    return result;
}

// The place or direction; of four corners, the mean.
VarId Lowering::mean_of_corners(const BuiltinRow& row, const std::vector<VarId>& args, Loc loc) {
    const std::size_t first = arg_position(row, 1);
    VarId sum = args[first];
    if (row.args.size() < 5) {
        return sum;
    }
    for (std::size_t i = 1; i < 4; ++i) {
        const VarId next = temp(var(sum).type, loc);
        emit(Op::Add, next, {sum, args[first + i]}, loc);
        sum = next;
    }
    const VarId mean = temp(var(sum).type, loc);
    emit(Op::Mul, mean, {sum, constant(0.25F)}, loc);
    return mean;
}

// trace(P, R) with the options; a float is the channel of its colour.
VarId Lowering::reflection(const BuiltinRow& row, const std::vector<VarId>& args, Loc loc) {
    std::vector<VarId> traced = {global(SL_VAR_P, loc), mean_of_corners(row, args, loc)};
    traced.insert(traced.end(),
                  args.begin() + static_cast<std::ptrdiff_t>(arg_position(row, row.args.size())),
                  args.end());
    const VarId color = builtin_by_body("trace_c", std::move(traced), Type::Color, loc);
    if (row.result.type == Type::Color) {
        return color;
    }
    const VarId channel = temp(Type::Float, loc);
    emit(Op::Component, channel, {color, args[1]}, loc);
    return channel;
}

// The light loop or the light shader around it says where the light is.
VarId Lowering::traced_shadow(const BuiltinRow& row, const std::vector<VarId>& args, Loc loc) {
    const bool in_light = shader_.type == SL_SHADER_light;
    const Type type = row.result.type;
    if (illuminance_depth_ == 0 && illuminate_depth_ == 0) {
        return convert(builtin_by_body("shadow_no_light", {}, Type::Float, loc), type, loc);
    }
    VarId to_light = global(SL_VAR_L, loc);
    if (in_light) {
        const VarId turned = temp(Type::Vector, loc);
        emit(Op::Neg, turned, {to_light}, loc);
        to_light = turned;
    }
    std::vector<VarId> asked = {mean_of_corners(row, args, loc), to_light};
    asked.insert(asked.end(),
                 args.begin() + static_cast<std::ptrdiff_t>(arg_position(row, row.args.size())),
                 args.end());
    return builtin_by_body(type == Type::Color ? "shadow_rays_c" : "shadow_rays_f",
                           std::move(asked), type, loc);
}

} // namespace slc
