// SPDX-License-Identifier: Apache-2.0
#include "tracer/displaced_batch.h"

#include "runtime/base/vec.h"

#include <algorithm>
#include <cmath>

namespace trace {

namespace {

using base::V3d;

constexpr std::uint64_t bit(sl_variable id) {
    return 1ULL << id;
}

constexpr std::uint64_t derivative_bits = bit(SL_VAR_dPdu) | bit(SL_VAR_dPdv);
// What a displacement shader may assign.
constexpr std::uint64_t result_bits = bit(SL_VAR_P) | bit(SL_VAR_N) | bit(SL_VAR_s) | bit(SL_VAR_t);
constexpr sl_variable results[] = {SL_VAR_P, SL_VAR_N, SL_VAR_s, SL_VAR_t};

bool writes(const sl_object& object, sl_variable id) {
    return (object.written & bit(id)) != 0;
}

// The differences of P change, so the tangents do.
bool bends(const sl_object& object) {
    return writes(object, SL_VAR_P) && (object.written_aux & bit(SL_VAR_P)) != 0;
}

bool wants_derivatives(const sl_object& object, NeededVariables needed) {
    return bends(object) && (needed.main & derivative_bits) != 0;
}

bool wants_normal(const sl_object& object, NeededVariables needed) {
    const bool N_follows = (needed.main & bit(SL_VAR_N)) != 0 && !writes(object, SL_VAR_N);
    return bends(object) && (N_follows || (needed.main & bit(SL_VAR_Ng)) != 0);
}

bool wants_incident(const sl_object& object, NeededVariables needed) {
    return writes(object, SL_VAR_P) && (needed.main & bit(SL_VAR_I)) != 0;
}

std::size_t components(sl_variable id) {
    return id == SL_VAR_s || id == SL_VAR_t ? 1 : 3;
}

} // namespace

std::uint64_t changed_by(const sl_object& displacement) {
    std::uint64_t changed = displacement.written & result_bits;
    if (writes(displacement, SL_VAR_P)) {
        changed |= bit(SL_VAR_I);
    }
    if (bends(displacement)) {
        changed |= derivative_bits | bit(SL_VAR_Ng) | bit(SL_VAR_N);
    }
    return changed;
}

NeededVariables DisplacedBatch::needed_before(const sl_object& displacement,
                                              NeededVariables after) {
    NeededVariables before{displacement.needed, displacement.needed_aux | displacement.written_aux};
    if (wants_derivatives(displacement, after)) {
        before.main |= bit(SL_VAR_du) | bit(SL_VAR_dv);
    }
    if (wants_normal(displacement, after)) {
        before.main |= derivative_bits | bit(SL_VAR_Ng) | bit(SL_VAR_du) | bit(SL_VAR_dv);
    }
    if (wants_incident(displacement, after)) {
        before.main |= bit(SL_VAR_P);
    }
    return before;
}

void DisplacedBatch::scratch(sl_variable id, float* planes) {
    if ((filled_ & bit(id)) != 0 && points_.var[id] == nullptr) {
        points_.var[id] = planes;
    }
}

void DisplacedBatch::begin(rt::ShadeBatch& batch, NeededVariables needed) {
    const sl_object& object = batch.instance().object();
    batch_ = &batch;
    filled_ = needed_before(object, needed).main;
    keeps_position_ = wants_incident(object, needed);
    has_derivatives_ = wants_derivatives(object, needed);
    has_normal_ = wants_normal(object, needed);
    points_ = batch.points();
    scratch(SL_VAR_dPdu, dPdu_.values.data());
    scratch(SL_VAR_dPdv, dPdv_.values.data());
    scratch(SL_VAR_Ng, Ng_.values.data());
    scratch(SL_VAR_du, du_.data());
    scratch(SL_VAR_dv, dv_.data());
}

void DisplacedBatch::keep_position() {
    if (keeps_position_) {
        std::copy_n(points_.var[SL_VAR_P], 3 * std::size_t{batch_->stride()},
                    P_before_.values.data());
    }
}

namespace {

V3d triple(const float* planes, std::size_t stride, std::size_t i) {
    return {static_cast<double>(planes[i]), static_cast<double>(planes[stride + i]),
            static_cast<double>(planes[2 * stride + i])};
}

void put(float* planes, std::size_t stride, std::size_t i, const V3d& v) {
    for (int k = 0; k < 3; ++k) {
        planes[static_cast<std::size_t>(k) * stride + i] = static_cast<float>(v[k]);
    }
}

// Unit normal of the displaced tangents, turned from them as Ng was from the undisplaced ones; at
// poles, where those vanish, on the side of Ng. Zero: there is none.
V3d displaced_normal(const V3d& dPdu, const V3d& dPdv, const V3d& dPdu_before,
                     const V3d& dPdv_before, const V3d& Ng) {
    const V3d n = base::cross(dPdu, dPdv);
    const double length = base::length(n);
    const double scale = base::length(dPdu) * base::length(dPdv);
    constexpr double least_sine = 1e-12;
    if (!(length > least_sine * scale) || !std::isfinite(length)) {
        return {};
    }
    const V3d before = base::cross(dPdu_before, dPdv_before);
    const double side = base::dot(before, Ng);
    const bool is_singular =
        !(std::fabs(side) > 1e-6 * base::length(dPdu_before) * base::length(dPdv_before));
    const double turned = is_singular ? base::dot(n, Ng) : side;
    return n * ((turned < 0 ? -1 : 1) / length);
}

} // namespace

void DisplacedBatch::finish_point(std::size_t i) {
    const std::size_t stride = batch_->stride();
    const float du = points_.var[SL_VAR_du][i], dv = points_.var[SL_VAR_dv][i];
    const V3d dPdu = triple(batch_->aux_u(SL_VAR_P), stride, i) / static_cast<double>(du);
    const V3d dPdv = triple(batch_->aux_v(SL_VAR_P), stride, i) / static_cast<double>(dv);
    if (has_normal_) {
        const V3d Ng = triple(points_.var[SL_VAR_Ng], stride, i);
        const V3d n = displaced_normal(dPdu, dPdv, triple(points_.var[SL_VAR_dPdu], stride, i),
                                       triple(points_.var[SL_VAR_dPdv], stride, i), Ng);
        put(N_.values.data(), stride, i, n);
        put(points_.var[SL_VAR_Ng], stride, i, n == V3d() ? Ng : n);
    }
    if (has_derivatives_) {
        put(dPdu_.values.data(), stride, i, dPdu);
        put(dPdv_.values.data(), stride, i, dPdv);
    }
}

void DisplacedBatch::finish() {
    for (std::size_t i = 0; (has_normal_ || has_derivatives_) && i < batch_->count(); ++i) {
        finish_point(i);
    }
}

namespace {

// Rays of an orthographic camera stay parallel: they meet the moved point from beside.
bool is_parallel(const ShadingView& view, std::size_t i) {
    return !view.perspective && view.incident.dx[i] == 0 && view.incident.dy[i] == 0;
}

} // namespace

// I goes with P, since the eye stays where it is.
void DisplacedBatch::move_incident(float* I, const ShadingView& view) const {
    const std::size_t stride = batch_->stride();
    const float* const P = batch_->plane(SL_VAR_P);
    for (std::size_t i = 0; i < batch_->count(); ++i) {
        for (std::size_t k = is_parallel(view, i) ? 2 : 0; k < 3; ++k) {
            I[k * stride + i] += P[k * stride + i] - P_before_.values[k * stride + i];
        }
    }
}

void DisplacedBatch::apply_differences(const sl_points& out, const sl_points& from,
                                       const ShadingView& view) const {
    const std::size_t stride = batch_->stride();
    const std::uint64_t stored = batch_->instance().object().written_aux;
    for (const sl_variable id : results) {
        if ((stored & bit(id)) != 0 && out.var[id] != nullptr) {
            std::copy_n(from.var[id], components(id) * stride, out.var[id]);
        }
    }
    float* const I = out.var[SL_VAR_I];
    for (std::size_t i = 0; I != nullptr && (stored & bit(SL_VAR_P)) != 0 && i < batch_->count();
         ++i) {
        for (std::size_t k = is_parallel(view, i) ? 2 : 0; k < 3; ++k) {
            I[k * stride + i] = from.var[SL_VAR_P][k * stride + i];
        }
    }
}

void DisplacedBatch::apply_normal(const sl_points& out) const {
    const std::size_t stride = batch_->stride();
    if (out.var[SL_VAR_Ng] != nullptr) {
        std::copy_n(points_.var[SL_VAR_Ng], 3 * stride, out.var[SL_VAR_Ng]);
    }
    if (out.var[SL_VAR_N] == nullptr || writes(batch_->instance().object(), SL_VAR_N)) {
        return;
    }
    for (std::size_t i = 0; i < batch_->count(); ++i) {
        const V3d n = triple(N_.values.data(), stride, i);
        if (n != V3d()) {
            put(out.var[SL_VAR_N], stride, i, n);
        }
    }
}

void DisplacedBatch::apply(const sl_points& main, const sl_points* aux_u, const sl_points* aux_v,
                           const ShadingView& view) const {
    const std::size_t stride = batch_->stride();
    const auto copy = [&](sl_variable id, const float* from) {
        if (main.var[id] != nullptr) {
            std::copy_n(from, components(id) * stride, main.var[id]);
        }
    };
    for (const sl_variable id : results) {
        if (writes(batch_->instance().object(), id)) {
            copy(id, batch_->plane(id));
        }
    }
    if (keeps_position_ && main.var[SL_VAR_I] != nullptr) {
        move_incident(main.var[SL_VAR_I], view);
    }
    if (has_derivatives_) {
        copy(SL_VAR_dPdu, dPdu_.values.data());
        copy(SL_VAR_dPdv, dPdv_.values.data());
    }
    if (has_normal_) {
        apply_normal(main);
    }
    if (aux_u != nullptr && aux_v != nullptr && batch_->aux_points_u() != nullptr) {
        apply_differences(*aux_u, *batch_->aux_points_u(), view);
        apply_differences(*aux_v, *batch_->aux_points_v(), view);
    }
}

} // namespace trace
