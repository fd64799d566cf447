// SPDX-License-Identifier: Apache-2.0
// Shaders that trace rays, by hand: what slc makes of them, without slc. Surfaces wait in their
// frames; lights and volumes ask the service.
#include "sl_fingerprint.h"
#include "tracer/test_world.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>

namespace trace::test {

namespace {

constexpr std::uint32_t lanes = 8;

struct Block {
    alignas(16) float weight;  // of what a ray brings
    alignas(16) float emits;   // added to it
    alignas(16) float density; // volumes
    alignas(16) float samples; // gather: rounds
    alignas(16) float angle;
    alignas(16) float sent; // what gather() sends as "emits"; negative: nothing
};
const sl_param params[] = {
    {"weight", SL_TYPE_float, SL_DETAIL_uniform, 0, 0, offsetof(Block, weight), 0},
    {"emits", SL_TYPE_float, SL_DETAIL_uniform, 0, 0, offsetof(Block, emits), 0},
    {"density", SL_TYPE_float, SL_DETAIL_uniform, 0, 0, offsetof(Block, density), 0},
    {"samples", SL_TYPE_float, SL_DETAIL_uniform, 0, 0, offsetof(Block, samples), 0},
    {"angle", SL_TYPE_float, SL_DETAIL_uniform, 0, 0, offsetof(Block, angle), 0},
    {"sent", SL_TYPE_float, SL_DETAIL_uniform, 0, 0, offsetof(Block, sent), 0},
};

void init(const sl_init* in) {
    auto* block = static_cast<Block*>(in->params);
    constexpr float defaults[] = {1, 0, 0, 1, 0, -1};
    for (std::size_t i = 0; i < std::size(params); ++i) {
        if (in->bound[i] == 0) {
            *reinterpret_cast<float*>(reinterpret_cast<std::byte*>(block) + params[i].offset) =
                defaults[i];
        }
    }
}

const Block& block_of(const sl_batch* batch) {
    return *static_cast<const Block*>(batch->params);
}

base::V3f get(const sl_batch* batch, sl_variable id, std::uint32_t i) {
    const float* p = batch->main->var[id];
    return {p[i], p[batch->stride + i], p[2 * batch->stride + i]};
}

void set(const sl_batch* batch, sl_variable id, std::uint32_t i, const base::V3f& v) {
    for (std::uint32_t k = 0; k < 3; ++k) {
        batch->main->var[id][k * batch->stride + i] = v[static_cast<int>(k)];
    }
}

void ask(sl_ray_query& query, int kind, std::uint32_t first, std::uint32_t count) {
    query = {};
    query.kind = kind;
    query.first = first;
    query.lanes = lanes;
    query.mask = (1U << count) - 1;
    query.samples = 1;
    static constexpr float defaults[] = {
#define SL_RAY_NUMBER(name, default, note) default,
#include "runtime/abi/sl_ray_options.def"
    };
    for (std::size_t k = 0; k < std::size(defaults); ++k) {
        std::fill_n(query.option[k], lanes, defaults[k]);
    }
}

base::V3f color(const sl_ray_query& query, std::uint32_t lane) {
    return {query.C[lane], query.C[lanes + lane], query.C[2 * lanes + lane]};
}

// Rays from the points of a packet along I, mirrored in the sheet or not.
void aim(sl_ray_query& query, const sl_batch* batch, std::uint32_t first, std::uint32_t count,
         bool mirrored) {
    for (std::uint32_t lane = 0; lane < count; ++lane) {
        const base::V3f P = get(batch, SL_VAR_P, first + lane);
        base::V3f D = get(batch, SL_VAR_I, first + lane);
        D.z = mirrored ? -D.z : D.z;
        for (std::uint32_t k = 0; k < 3; ++k) {
            query.P[k * lanes + lane] = P[static_cast<int>(k)];
            query.D[k * lanes + lane] = D[static_cast<int>(k)];
        }
    }
}

void finish(const sl_batch* batch, std::uint32_t i, const base::V3f& Ci) {
    set(batch, SL_VAR_Ci, i, Ci);
    set(batch, SL_VAR_Oi, i, {1, 1, 1});
}

// --- surfaces

// Ci = emits + weight * trace(P, reflect(I, N))
sl_status mirror(const sl_batch* batch, std::uint32_t first, std::uint32_t count, sl_frame* frame) {
    if (frame->state == 0) {
        ask(frame->rays, SL_RAYS_trace, first, count);
        aim(frame->rays, batch, first, count, true);
        frame->state = 1;
        return SL_SUSPENDED;
    }
    const Block& block = block_of(batch);
    for (std::uint32_t lane = 0; lane < count; ++lane) {
        finish(batch, first + lane,
               base::V3f(block.emits) + color(frame->rays, lane) * block.weight);
    }
    return SL_DONE;
}

struct GlassFrame {
    sl_frame head;
    float reflected[3 * lanes];
};

// Ci = weight * trace(P, reflect(I, N)) + (1 - weight) * trace(P, I), one after the other
sl_status glass(const sl_batch* batch, std::uint32_t first, std::uint32_t count, sl_frame* frame) {
    auto* own = reinterpret_cast<GlassFrame*>(frame);
    if (frame->state < 2) {
        if (frame->state == 1) {
            std::copy_n(frame->rays.C, 3 * lanes, own->reflected);
        }
        ask(frame->rays, SL_RAYS_trace, first, count);
        aim(frame->rays, batch, first, count, frame->state == 0);
        ++frame->state;
        return SL_SUSPENDED;
    }
    const float weight = block_of(batch).weight;
    for (std::uint32_t lane = 0; lane < count; ++lane) {
        const base::V3f reflected(own->reflected[lane], own->reflected[lanes + lane],
                                  own->reflected[2 * lanes + lane]);
        finish(batch, first + lane, reflected * weight + color(frame->rays, lane) * (1 - weight));
    }
    return SL_DONE;
}

// Ci = (distance to the first hit, level of the deepest miss, z of its direction)
sl_status probe(const sl_batch* batch, std::uint32_t first, std::uint32_t count, sl_frame* frame) {
    if (frame->state == 0) {
        ask(frame->rays, SL_RAYS_fulltrace, first, count);
        aim(frame->rays, batch, first, count, true);
        frame->state = 1;
        return SL_SUSPENDED;
    }
    const sl_ray_query& rays = frame->rays;
    for (std::uint32_t lane = 0; lane < count; ++lane) {
        finish(batch, first + lane,
               {rays.distance[lane], rays.level_missed[lane], rays.Rmiss[2 * lanes + lane]});
    }
    return SL_DONE;
}

struct GatherFrame {
    sl_frame head;
    float sum[3 * lanes]; // of surface:Ci, ray:length and hits
    std::int32_t round;
};

void ask_round(const sl_batch* batch, std::uint32_t first, std::uint32_t count, GatherFrame& own) {
    const Block& block = block_of(batch);
    sl_ray_query& query = own.head.rays;
    ask(query, SL_RAYS_gather, first, count);
    aim(query, batch, first, count, true);
    std::fill_n(query.angle, lanes, block.angle);
    query.sample = own.round;
    query.samples = static_cast<int>(block.samples);
    query.num_channels = block.sent >= 0 ? 3 : 2;
    query.channel[0].name = batch->strings[0];
    query.channel[0].type = SL_TYPE_color;
    query.channel[1].name = batch->strings[1];
    query.channel[1].type = SL_TYPE_float;
    query.channel[2].name = batch->strings[2];
    query.channel[2].type = SL_TYPE_float;
    query.channel[2].is_sent = 1;
    std::fill_n(query.channel[2].values, lanes, block.sent);
}

// Ci = means of (red of surface:Ci, ray:length, share of hits)
sl_status gathering(const sl_batch* batch, std::uint32_t first, std::uint32_t count,
                    sl_frame* frame) {
    auto* own = reinterpret_cast<GatherFrame*>(frame);
    const float samples = block_of(batch).samples;
    if (frame->state == 0) { // all else in a new frame is what was there before
        std::fill_n(own->sum, 3 * lanes, 0.0f);
        own->round = 0;
    }
    for (std::uint32_t lane = 0; frame->state == 1 && lane < count; ++lane) {
        const sl_ray_query& rays = frame->rays;
        if ((rays.hit >> lane & 1U) != 0) {
            own->sum[lane] += rays.channel[0].values[lane] / samples;
            own->sum[lanes + lane] += rays.channel[1].values[lane] / samples;
            own->sum[2 * lanes + lane] += 1 / samples;
        }
    }
    own->round += frame->state;
    if (static_cast<float>(own->round) < samples) {
        frame->state = 1;
        ask_round(batch, first, count, *own);
        return SL_SUSPENDED;
    }
    for (std::uint32_t lane = 0; lane < count; ++lane) {
        finish(batch, first + lane,
               {own->sum[lane], own->sum[lanes + lane], own->sum[2 * lanes + lane]});
    }
    return SL_DONE;
}

// --- volumes

// Absorbs: Ci exp(-density |I|); what it takes is opaque.
sl_status absorb(const sl_batch* batch, std::uint32_t first, std::uint32_t count, sl_frame*) {
    for (std::uint32_t i = first; i < first + count; ++i) {
        const float through =
            std::exp(-block_of(batch).density * base::length(get(batch, SL_VAR_I, i)));
        set(batch, SL_VAR_Ci, i, get(batch, SL_VAR_Ci, i) * through);
        set(batch, SL_VAR_Oi, i, get(batch, SL_VAR_Oi, i) * through + base::V3f(1 - through));
    }
    return SL_DONE;
}

// --- lights

// Light along +z as bright as what lies behind the point it lights: asks the service.
sl_status tracing_light(const sl_batch* batch, std::uint32_t first, std::uint32_t count,
                        sl_frame*) {
    sl_ray_query query;
    ask(query, SL_RAYS_trace, first, count);
    for (std::uint32_t lane = 0; lane < count; ++lane) {
        for (std::uint32_t k = 0; k < 3; ++k) {
            query.P[k * lanes + lane] = get(batch, SL_VAR_Ps, first + lane)[static_cast<int>(k)];
        }
        query.D[2 * lanes + lane] = -1;
    }
    batch->services->rays(batch->engine, &query);
    for (std::uint32_t lane = 0; lane < count; ++lane) {
        set(batch, SL_VAR_L, first + lane, {0, 0, 1});
        set(batch, SL_VAR_Cl, first + lane, color(query, lane));
        batch->lit[(first + lane) / lanes] |= 1U << ((first + lane) % lanes);
    }
    return SL_DONE;
}

// --- the objects

constexpr std::uint64_t bits(std::initializer_list<sl_variable> ids) {
    std::uint64_t mask = 0;
    for (const sl_variable id : ids) {
        mask |= 1ULL << id;
    }
    return mask;
}

struct Row {
    const char* name;
    sl_shader_type type;
    sl_status (*shade)(const sl_batch*, std::uint32_t, std::uint32_t, sl_frame*);
    std::size_t frame_size;
    std::uint32_t facts;
    std::uint64_t needed, written;
};

constexpr std::uint64_t results = bits({SL_VAR_Ci, SL_VAR_Oi});
constexpr std::uint64_t seen = bits({SL_VAR_P, SL_VAR_I});
const Row rows[] = {
    {"mirror", SL_SHADER_surface, mirror, sizeof(sl_frame), SL_FACT_traces, seen, results},
    {"glass", SL_SHADER_surface, glass, sizeof(GlassFrame), SL_FACT_traces, seen, results},
    {"probe", SL_SHADER_surface, probe, sizeof(sl_frame), SL_FACT_traces, seen, results},
    {"gathering", SL_SHADER_surface, gathering, sizeof(GatherFrame), SL_FACT_traces, seen, results},
    {"absorb", SL_SHADER_volume, absorb, 0, 0, bits({SL_VAR_I}) | results, results},
    {"tracing_light", SL_SHADER_light, tracing_light, 0,
     SL_FACT_directional | SL_FACT_solar | SL_FACT_traces, bits({SL_VAR_Ps}),
     bits({SL_VAR_L, SL_VAR_Cl})},
};

const char* const strings[] = {"surface:Ci", "ray:length", "send:surface:emits"};

struct Made {
    sl_variant variant;
    const sl_variant* variants[1];
    sl_object object;
};

void make(const Row& row, Made& made) {
    made.variant = {SL_ISA_any,
                    static_cast<int>(lanes),
                    static_cast<std::uint32_t>(row.frame_size),
                    64,
                    row.shade,
                    init};
    made.variants[0] = &made.variant;
    sl_object& o = made.object;
    o = {};
    o.fingerprint = SL_ABI_FINGERPRINT;
    o.name = row.name;
    o.type = row.type;
    o.num_params = static_cast<int>(std::size(params));
    o.params = params;
    o.params_size = sizeof(Block);
    o.facts = row.facts;
    o.needed = row.needed;
    o.written = row.written;
    o.num_strings = static_cast<int>(std::size(strings));
    o.strings = strings;
    o.num_variants = 1;
    o.variants = made.variants;
    o.ir = "";
    o.source = "test_ray_shaders.cpp";
}

} // namespace

void adopt_test_ray_shaders(rt::ShaderLibrary& library) {
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
