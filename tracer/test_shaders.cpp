// SPDX-License-Identifier: Apache-2.0
// Shader objects by hand, one point at a time: what slc makes, without slc.
#include "sl_fingerprint.h"
#include "tracer/test_world.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <memory>

namespace trace::test {

namespace {

constexpr int lanes = 8;

// Access to one point of a batch.
struct Point {
    const sl_batch* batch;
    std::uint32_t i;
    [[nodiscard]] base::V3f get(sl_variable id) const {
        const float* p = batch->main->var[id];
        const std::uint32_t s = batch->stride;
        return {p[i], p[s + i], p[2 * s + i]};
    }
    void set(sl_variable id, const base::V3f& v) const {
        for (int k = 0; k < 3; ++k) {
            batch->main->var[id][static_cast<std::uint32_t>(k) * batch->stride + i] = v[k];
        }
    }
};

template <class Body>
sl_status each(const sl_batch* batch, std::uint32_t first, std::uint32_t count, Body body) {
    for (std::uint32_t i = first; i < first + count; ++i) {
        body(Point{batch, i});
    }
    return SL_DONE;
}

base::V3f times(const base::V3f& a, const base::V3f& b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}

void no_init(const sl_init*) {}

// --- surfaces

sl_status flat(const sl_batch* batch, std::uint32_t first, std::uint32_t count, sl_frame*) {
    return each(batch, first, count, [](Point p) {
        p.set(SL_VAR_Oi, p.get(SL_VAR_Os));
        p.set(SL_VAR_Ci, times(p.get(SL_VAR_Os), p.get(SL_VAR_Cs)));
    });
}

struct LitBlock {
    alignas(16) float cone; // half angle; pi/2 is diffuse()
    alignas(16) sl_string category;
    alignas(16) float lightcount;
};
const sl_param lit_params[] = {
    {"cone", SL_TYPE_float, SL_DETAIL_uniform, 0, 0, offsetof(LitBlock, cone), 0},
    {"category", SL_TYPE_string, SL_DETAIL_uniform, 0, 0, offsetof(LitBlock, category), 0},
};
void init_lit(const sl_init* in) {
    auto* block = static_cast<LitBlock*>(in->params);
    block->cone = in->bound[0] != 0 ? block->cone : 1.57079632679f;
    block->category = in->bound[1] != 0 ? block->category : in->strings[0];
}

// ambient() + sum over lights of Cl (1 - __nondiffuse) L.N/|L|, twice over: the second pass meets
// reused results.
sl_status lit(const sl_batch* batch, std::uint32_t first, std::uint32_t count, sl_frame*) {
    const auto* block = static_cast<const LitBlock*>(batch->params);
    const std::uint32_t mask = (1U << count) - 1;
    float P[3 * lanes] = {}, N[3 * lanes] = {}, cosangle[lanes] = {}, sum[3 * lanes] = {};
    for (std::uint32_t i = 0; i < count; ++i) {
        const Point p{batch, first + i};
        for (int k = 0; k < 3; ++k) {
            P[k * lanes + static_cast<int>(i)] = p.get(SL_VAR_P)[k];
            N[k * lanes + static_cast<int>(i)] = p.get(SL_VAR_N)[k];
        }
        cosangle[i] = block->cone > 1.57f && block->cone < 1.58f ? 0 : std::cos(block->cone);
    }
    batch->services->ambient(batch->engine, first, mask, P, sum);
    for (int pass = 0; pass < 2; ++pass) {
        for (int index = 0; index < batch->services->light_count(batch->engine); ++index) {
            sl_light_result result;
            const sl_light_query query = {index,    first,           lanes, mask, P, nullptr, N,
                                          cosangle, block->category, 0,     0,    0, nullptr};
            const std::uint32_t reached = batch->services->light(batch->engine, &query, &result);
            for (std::uint32_t i = 0; i < count; ++i) {
                if ((reached >> i & 1U) == 0) {
                    continue;
                }
                const base::V3f L(result.L[i], result.L[lanes + i], result.L[2 * lanes + i]);
                const float cosine =
                    base::dot(L, Point{batch, first + i}.get(SL_VAR_N)) / base::length(L);
                for (std::uint32_t k = 0; k < 3; ++k) {
                    sum[k * lanes + i] +=
                        0.5f * cosine * (1 - result.nondiffuse[i]) * result.Cl[k * lanes + i];
                }
            }
        }
    }
    for (std::uint32_t i = 0; i < count; ++i) {
        const Point p{batch, first + i};
        p.set(SL_VAR_Ci, times(p.get(SL_VAR_Cs), {sum[i], sum[lanes + i], sum[2 * lanes + i]}));
        p.set(SL_VAR_Oi, {1, 1, 1});
    }
    return SL_DONE;
}

struct TintBlock {
    alignas(16) float tint[3];
    alignas(16) float* scale;
    alignas(16) float scale_default;
};
const sl_param tint_params[] = {
    {"tint", SL_TYPE_color, SL_DETAIL_uniform, 0, 0, offsetof(TintBlock, tint), 0},
    {"scale", SL_TYPE_float, SL_DETAIL_varying, 0, 0, offsetof(TintBlock, scale), 0},
};
void init_tint(const sl_init* in) {
    auto* block = static_cast<TintBlock*>(in->params);
    if (in->bound[0] == 0) {
        std::fill_n(block->tint, 3, 1.0f);
    }
    if (in->bound[1] == 0) {
        block->scale_default = 1;
    }
}
sl_status tint(const sl_batch* batch, std::uint32_t first, std::uint32_t count, sl_frame*) {
    const auto* block = static_cast<const TintBlock*>(batch->params);
    return each(batch, first, count, [block](Point p) {
        p.set(SL_VAR_Ci,
              base::V3f(block->tint[0], block->tint[1], block->tint[2]) * block->scale[p.i]);
        p.set(SL_VAR_Oi, {1, 1, 1});
    });
}

sl_status unset(const sl_batch*, std::uint32_t, std::uint32_t, sl_frame*) {
    return SL_DONE;
}

sl_status bad(const sl_batch* batch, std::uint32_t first, std::uint32_t count, sl_frame*) {
    return each(batch, first, count, [](Point p) {
        const float nan = std::numeric_limits<float>::quiet_NaN();
        p.set(SL_VAR_Ci, p.get(SL_VAR_P).x > 0 ? base::V3f(nan, 0, 0) : base::V3f(1, 1, 1));
        p.set(SL_VAR_Oi, {1, 1, 1});
    });
}

sl_status spaces(const sl_batch* batch, std::uint32_t first, std::uint32_t count, sl_frame*) {
    float m[16 * lanes];
    batch->services->space(batch->engine, nullptr, batch->strings[0], first, m);
    return each(batch, first, count, [&m](Point p) {
        const base::V3f P = p.get(SL_VAR_P);
        base::V3f r;
        for (int k = 0; k < 3; ++k) {
            r[k] = P.x * m[k] + P.y * m[4 + k] + P.z * m[8 + k] + m[12 + k];
        }
        p.set(SL_VAR_Ci, r);
        p.set(SL_VAR_Oi, {1, 1, 1});
    });
}

// --- lights

struct LightBlock {
    alignas(16) float intensity;
    alignas(16) float from[3];
    alignas(16) float to[3];
    alignas(16) float angle;
    alignas(16) float nondiffuse;
    alignas(16) sl_string category;
};
const sl_param light_params[] = {
    {"intensity", SL_TYPE_float, SL_DETAIL_uniform, 0, 0, offsetof(LightBlock, intensity), 0},
    {"from", SL_TYPE_point, SL_DETAIL_uniform, 0, 0, offsetof(LightBlock, from), 0},
    {"to", SL_TYPE_point, SL_DETAIL_uniform, 0, 0, offsetof(LightBlock, to), 0},
    {"angle", SL_TYPE_float, SL_DETAIL_uniform, 0, 0, offsetof(LightBlock, angle), 0},
    {"__nondiffuse", SL_TYPE_float, SL_DETAIL_uniform, 0, 0, offsetof(LightBlock, nondiffuse), 0},
    {"__category", SL_TYPE_string, SL_DETAIL_uniform, 0, 0, offsetof(LightBlock, category), 0},
};

// Defaults point "shader" (0,0,0) and (0,0,1): only the matrix's columns are needed.
void init_light(const sl_init* in) {
    auto* block = static_cast<LightBlock*>(in->params);
    float m[16 * lanes];
    in->services->space(in->engine, in->strings[1], nullptr, 0, m);
    block->intensity = in->bound[0] != 0 ? block->intensity : 1;
    for (int k = 0; k < 3; ++k) {
        block->from[k] = in->bound[1] != 0 ? block->from[k] : m[12 + k];
        block->to[k] = in->bound[2] != 0 ? block->to[k] : m[8 + k] + m[12 + k];
    }
    block->angle = in->bound[3] != 0 ? block->angle : 0.5f;
    block->nondiffuse = in->bound[4] != 0 ? block->nondiffuse : 0;
    block->category = in->bound[5] != 0 ? block->category : in->strings[0];
}

enum class LightKind { Ambient, Point, Distant, Cone };

template <LightKind kind>
sl_status light(const sl_batch* batch, std::uint32_t first, std::uint32_t count, sl_frame*) {
    const auto* block = static_cast<const LightBlock*>(batch->params);
    const base::V3f from(block->from[0], block->from[1], block->from[2]);
    const base::V3f axis = base::V3f(block->to[0], block->to[1], block->to[2]) - from;
    return each(batch, first, count, [&](Point p) {
        if (kind == LightKind::Ambient) {
            p.set(SL_VAR_Cl, base::V3f(block->intensity));
            return;
        }
        const base::V3f L = kind == LightKind::Distant ? axis : p.get(SL_VAR_Ps) - from;
        p.set(SL_VAR_L, L);
        const float cosine = base::dot(base::normalize(L), base::normalize(axis));
        if (kind == LightKind::Cone && cosine < std::cos(block->angle)) {
            p.set(SL_VAR_Cl, {0, 0, 0});
            return;
        }
        const float falloff = kind == LightKind::Distant ? 1 : 1 / base::dot(L, L);
        p.set(SL_VAR_Cl, base::V3f(block->intensity * falloff));
        batch->lit[p.i / lanes] |= 1U << (p.i % lanes);
    });
}

// --- volume, imager

// Ci = mix(Ci, 1, clamp(|I| / 10)): linear, so that the closed form is plain.
sl_status haze(const sl_batch* batch, std::uint32_t first, std::uint32_t count, sl_frame*) {
    return each(batch, first, count, [](Point p) {
        const float d = std::min(base::length(p.get(SL_VAR_I)) / 10, 1.0f);
        p.set(SL_VAR_Ci, p.get(SL_VAR_Ci) * (1 - d) + base::V3f(d));
        p.set(SL_VAR_Oi, p.get(SL_VAR_Oi) * (1 - d) + base::V3f(d));
    });
}

sl_status invert(const sl_batch* batch, std::uint32_t first, std::uint32_t count, sl_frame*) {
    return each(batch, first, count, [](Point p) {
        p.set(SL_VAR_Ci, base::V3f(1) - p.get(SL_VAR_Ci));
        p.set(SL_VAR_Oi, p.get(SL_VAR_P));
        p.batch->main->var[SL_VAR_alpha][p.i] += 0.25f;
    });
}

// --- the objects

constexpr std::uint64_t bits(std::initializer_list<sl_variable> ids) {
    std::uint64_t mask = 0;
    for (const sl_variable id : ids) {
        mask |= 1ULL << id;
    }
    return mask;
}

using Shade = sl_status (*)(const sl_batch*, std::uint32_t, std::uint32_t, sl_frame*);
struct Row {
    const char* name;
    sl_shader_type type;
    Shade shade;
    void (*init)(const sl_init*);
    std::span<const sl_param> params;
    std::size_t params_size;
    std::uint32_t facts;
    std::uint64_t needed, written;
};

constexpr std::uint64_t results = bits({SL_VAR_Ci, SL_VAR_Oi});
constexpr std::uint64_t light_results = bits({SL_VAR_L, SL_VAR_Cl});

const Row rows[] = {
    {"flat", SL_SHADER_surface, flat, no_init, {}, 0, 0, bits({SL_VAR_Cs, SL_VAR_Os}), results},
    {"lit", SL_SHADER_surface, lit, init_lit, lit_params, sizeof(LitBlock),
     SL_FACT_lights | SL_FACT_ambient, bits({SL_VAR_P, SL_VAR_N, SL_VAR_Cs}), results},
    {"tint", SL_SHADER_surface, tint, init_tint, tint_params, sizeof(TintBlock), 0, 0, results},
    {"unset", SL_SHADER_surface, unset, no_init, {}, 0, 0, 0, 0},
    {"bad", SL_SHADER_surface, bad, no_init, {}, 0, 0, bits({SL_VAR_P}), results},
    {"spaces",
     SL_SHADER_surface,
     spaces,
     no_init,
     {},
     0,
     SL_FACT_object_space,
     bits({SL_VAR_P}),
     results},
    {"ambient", SL_SHADER_light, light<LightKind::Ambient>, init_light, light_params,
     sizeof(LightBlock), 0, 0, bits({SL_VAR_Cl})},
    {"point", SL_SHADER_light, light<LightKind::Point>, init_light, light_params,
     sizeof(LightBlock), SL_FACT_directional, bits({SL_VAR_Ps}), light_results},
    {"distant", SL_SHADER_light, light<LightKind::Distant>, init_light, light_params,
     sizeof(LightBlock), SL_FACT_directional | SL_FACT_solar, bits({SL_VAR_Ps}), light_results},
    {"cone", SL_SHADER_light, light<LightKind::Cone>, init_light, light_params, sizeof(LightBlock),
     SL_FACT_directional, bits({SL_VAR_Ps}), light_results},
    {"haze",
     SL_SHADER_volume,
     haze,
     no_init,
     {},
     0,
     0,
     bits({SL_VAR_I, SL_VAR_Ci, SL_VAR_Oi}),
     results},
    {"invert",
     SL_SHADER_imager,
     invert,
     no_init,
     {},
     0,
     0,
     bits({SL_VAR_Ci, SL_VAR_P, SL_VAR_alpha}),
     results | bits({SL_VAR_alpha})},
};

const char* const empty_and_shader[] = {"", "shader"};
const char* const object_name[] = {"object"};

struct Made {
    sl_variant variant;
    const sl_variant* variants[1];
    sl_object object;
};

void make(const Row& row, Made& made) {
    made.variant = {SL_ISA_any, lanes, 0, 0, row.shade, row.init};
    made.variants[0] = &made.variant;
    sl_object& o = made.object;
    o = {};
    o.fingerprint = SL_ABI_FINGERPRINT;
    o.name = row.name;
    o.type = row.type;
    o.num_params = static_cast<int>(row.params.size());
    o.params = row.params.data();
    o.params_size = static_cast<std::uint32_t>(row.params_size);
    o.facts = row.facts;
    o.needed = row.needed;
    o.written = row.written;
    const bool is_spaces = std::strcmp(row.name, "spaces") == 0;
    o.num_strings = is_spaces ? 1 : 2;
    o.strings = is_spaces ? object_name : empty_and_shader;
    o.num_variants = 1;
    o.variants = made.variants;
    o.ir = "";
    o.source = "test_shaders.cpp";
}

} // namespace

void adopt_test_shaders(rt::ShaderLibrary& library) {
    static const std::unique_ptr<Made[]> made = [] {
        auto all = std::make_unique<Made[]>(std::size(rows));
        for (std::size_t i = 0; i < std::size(rows); ++i) {
            make(rows[i], all[i]);
        }
        return all;
    }();
    for (std::size_t i = 0; i < std::size(rows); ++i) {
        library.adopt(made[i].object);
    }
}

} // namespace trace::test
