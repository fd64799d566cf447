// SPDX-License-Identifier: Apache-2.0
#include "tracer/test_world.h"

#include <bit>
#include <cmath>

namespace trace::test {

geo::Hit SheetWorld::closest(const geo::RayPacket& rays, int lane) const {
    geo::Hit hit;
    float best = rays.tfar[lane];
    for (std::uint32_t i = 0; i < sheets_.size(); ++i) {
        const float t = (sheets_[i].z - rays.oz[lane]) / rays.dz[lane];
        const float x = rays.ox[lane] + t * rays.dx[lane], y = rays.oy[lane] + t * rays.dy[lane];
        const bool inside =
            std::fabs(x) <= sheets_[i].half_width && std::fabs(y) <= sheets_[i].half_width;
        if (t > rays.tnear[lane] && t < best && inside) {
            best = t;
            hit = {i, 0, geo::no_id, x, y, t, rays.time[lane]};
        }
    }
    return hit;
}

void SheetWorld::intersect(const geo::RayPacket& rays, geo::Hit* hits) const {
    for (int lane = 0; lane < geo::RayPacket::size; ++lane) {
        hits[lane] = (rays.active >> lane & 1U) != 0 ? closest(rays, lane) : geo::Hit{};
    }
}

void SheetWorld::intersect(std::span<const geo::RayPacket> packets, geo::Hit* hits) const {
    for (std::size_t p = 0; p < packets.size(); ++p) {
        intersect(packets[p], hits + p * geo::RayPacket::size);
    }
}

std::uint32_t SheetWorld::occluded(const geo::RayPacket& rays) const {
    std::uint32_t mask = 0;
    for (int lane = 0; lane < geo::RayPacket::size; ++lane) {
        const bool active = (rays.active >> lane & 1U) != 0;
        mask |= active && closest(rays, lane).valid() ? 1U << lane : 0;
    }
    return mask;
}

geo::Binding SheetWorld::binding(const geo::Hit& hit) const {
    return {sheets_[hit.shape].attributes, hit.shape, geo::no_id, hit.shape};
}

void SheetWorld::fill(std::span<const geo::Hit> hits, const geo::Incident& incident,
                      std::uint64_t needed, std::uint32_t stride, const sl_points& out,
                      const sl_points*, const sl_points*) const {
    const auto set = [&](sl_variable id, std::size_t i, const base::V3f& value) {
        for (int k = 0; k < 3 && (needed >> id & 1U) != 0 && out.var[id] != nullptr; ++k) {
            out.var[id][static_cast<std::size_t>(k) * stride + i] = value[k];
        }
    };
    for (std::size_t i = 0; i < hits.size(); ++i) {
        const Sheet& sheet = sheets_[hits[i].shape];
        const rib::Attributes& attributes = scene_.attributes[sheet.attributes];
        const base::V3f P(hits[i].u, hits[i].v, sheet.z);
        set(SL_VAR_P, i, P);
        set(SL_VAR_N, i, {0, 0, sheet.side});
        set(SL_VAR_Ng, i, {0, 0, sheet.side});
        if (i < incident.ox.size()) {
            set(SL_VAR_I, i, P - base::V3f(incident.ox[i], incident.oy[i], incident.oz[i]));
        }
        set(SL_VAR_Cs, i, {attributes.color[0], attributes.color[1], attributes.color[2]});
        set(SL_VAR_Os, i, {attributes.opacity[0], attributes.opacity[1], attributes.opacity[2]});
    }
}

const rib::Param* SheetWorld::primitive_variable(const geo::Hit& hit, std::string_view name) const {
    const auto& variables = sheets_[hit.shape].variables;
    const auto it = variables.find(std::string(name));
    return it == variables.end() ? nullptr : &it->second;
}

void SheetWorld::fill_primitive_variable(std::span<const geo::Hit> hits, std::string_view name,
                                         std::uint32_t stride, float* out) const {
    for (std::size_t i = 0; i < hits.size(); ++i) {
        const rib::Param& param = *primitive_variable(hits[i], name);
        const bool varies = param.decl.storage != rib::StorageClass::Constant;
        for (std::size_t k = 0; k < param.floats.size(); ++k) {
            out[k * stride + i] = param.floats[k] * (varies ? hits[i].u : 1);
        }
    }
}

// Varying values go with u; nothing changes along v.
void SheetWorld::fill_primitive_differences(std::span<const geo::Hit> hits, std::string_view name,
                                            const geo::AuxiliaryPlanes& planes) const {
    for (std::size_t i = 0; i < hits.size(); ++i) {
        const rib::Param& param = *primitive_variable(hits[i], name);
        const bool varies = param.decl.storage != rib::StorageClass::Constant;
        for (std::size_t k = 0; k < param.floats.size(); ++k) {
            const std::size_t at = k * planes.stride + i;
            planes.out_u[at] = varies ? param.floats[k] * planes.du[i] : 0;
            planes.out_v[at] = 0;
        }
    }
}

base::V3f SheetWorld::spawn_origin(const geo::Hit& hit, const base::V3f& direction) const {
    const float z = sheets_[hit.shape].z;
    return {hit.u, hit.v, z + (direction.z > 0 ? 1e-5f : -1e-5f) * std::fabs(z)};
}

base::Mat4 SheetWorld::camera_from_object(const geo::Hit& hit, float) const {
    return sheets_[hit.shape].camera_from_object;
}

} // namespace trace::test
