/* SPDX-License-Identifier: Apache-2.0
 * Map lookups (texture, environment, shadow, bump), textureinfo and baking, for both worlds: the
 * arguments of a call become one query to the engine per packet; reference/sl.md 4.7, 4.9. Empty
 * names are answered here and are no error.
 */
#include "body.h"
#include "pairs.h"

/* A predefined variable; 0 in batches without it (defaults of parameters). */
static slf slv_global_f_(const sl_call* call, sli mask, int id) {
    (void)mask;
    return call->batch && call->batch->main->var[id] ? slv_var_f(call, id) : (slf){0};
}
static float slu_global_f_(const sl_call* call, int id) {
    return slv_global_f_(call, call->live, id)[sl_first_lane(call->live)];
}

/* --- options */

static void set_option(sl_map_query* query, int slot, const sl_value* value) {
    query->given |= 1u << slot;
    slv_put_plane_(query->option[slot], lanes_of(value));
}

static void take_option(sl_map_query* query, sl_string name, const sl_value* value) {
    if (same_text(name, "filter") && is_text(value))
        query->filter = text_of(value);
    if (value->type != SL_TYPE_float || value->array_length)
        return;
#define SL_MAP_SLOT(id, default, note)                                                             \
    if (same_text(name, #id))                                                                      \
        set_option(query, SL_MAP_OPTION_##id, value);
#define SL_MAP_BOTH(id, first, second)                                                             \
    if (same_text(name, #id)) {                                                                    \
        set_option(query, SL_MAP_OPTION_##first, value);                                           \
        set_option(query, SL_MAP_OPTION_##second, value);                                          \
    }
#include "sl_map_options.def"
}

static void take_options(sl_map_query* query, const sl_value* values, int n) {
    query->filter = 0;
    query->given = 0;
#define SL_MAP_SLOT(id, default, note)                                                             \
    slv_put_plane_(query->option[SL_MAP_OPTION_##id], slv_spread_f(default));
#include "sl_map_options.def"
    for (int i = 0; i + 1 < n; i += 2)
        if (is_text(&values[i]) && text_of(&values[i]))
            take_option(query, text_of(&values[i]), &values[i + 1]);
}

static void begin_query(const sl_call* call, sl_map_query* query, int kind, sl_string name,
                        uint32_t mask) {
    query->kind = kind;
    query->channel = 0;
    query->num_channels = 1;
    query->first = call->first;
    query->lanes = SL_LANES;
    query->mask = mask;
    for (int i = 0; i < SL_LANES; i++)
        query->name[i] = name;
}

static int channel_of(float channel) {
    return channel > 0 && channel < 1e6f ? (int)channel : 0;
}

/* --- textureinfo: the value is the same for all lanes */

enum { INFO_FLOATS = 16 };

static void put_info(sli mask, const sl_value* out, const float* values, int n) {
    for (int i = 0; i < n; i++) {
        if (!out->varying)
            ((float*)out->data)[i] = values[i];
        else
            ((slf*)out->data)[i] =
                slv_select_f(mask, slv_spread_f(values[i]), ((slf*)out->data)[i]);
    }
}

static void put_info_text(sli mask, const sl_value* out, sl_string text) {
    if (!out->varying)
        *(sl_string*)out->data = text;
    else
        *(sls*)out->data = slv_select_s(mask, slv_spread_s(text), *(sls*)out->data);
}

static float map_info(const sl_call* call, sli mask, sl_string name, sl_string key,
                      const sl_value* out) {
    union {
        float numbers[INFO_FLOATS];
        sl_string text;
    } value;
    const int elements = out->array_length > 0 ? out->array_length : 1;
    if (!is_named(name) || !key)
        return 0;
    if (out->type == SL_TYPE_string) {
        if (out->array_length || !call->services->map_info(call->engine, name, key, out->type,
                                                           out->array_length, &value))
            return 0;
        put_info_text(mask, out, value.text);
        return 1;
    }
    const int n = elements * components_of(out->type);
    for (int i = 0; i < INFO_FLOATS; i++)
        value.numbers[i] = 0;
    if (n > INFO_FLOATS ||
        !call->services->map_info(call->engine, name, key, out->type, out->array_length, &value))
        return 0;
    put_info(mask, out, value.numbers, n);
    return 1;
}

static float slu_textureinfo_(const sl_call* call, sl_string name, sl_string key,
                              const sl_value* out) {
    return map_info(call, call->live, name, key, out);
}
static slf slv_textureinfo_(const sl_call* call, sli mask, sl_string name, sl_string key,
                            const sl_value* out) {
    return slv_f_of_mask(mask) * map_info(call, mask, name, key, out);
}

/* --- point clouds: options and channels among the name/value pairs */

typedef struct point_samples {
    sl_point_query query;
    float at[6 * SL_LANES_MAX];
    float values[SL_POINT_CHANNELS_MAX][3 * SL_LANES_MAX];
} point_samples;

static void begin_points(const sl_call* call, point_samples* p, sl_string file, uint32_t mask,
                         int num_at) {
    p->query.file = file;
    p->query.num_at = num_at;
    p->query.first = call->first;
    p->query.lanes = SL_LANES;
    p->query.mask = mask;
    p->query.at = p->at;
    p->query.space = 0;
    p->query.radius = 0;
    p->query.radius_scale = 1;
    p->query.num_channels = 0;
}

static float first_number(const sl_value* value, uint32_t mask) {
    return lanes_of(value)[sl_first_lane(sl_mask(mask))];
}

/* True if the pair is an option and no channel. */
static int take_point_option(point_samples* p, sl_string name, const sl_value* value) {
    const int is_number = value->type == SL_TYPE_float && !value->array_length;
    if (same_text(name, "coordsystem") && is_text(value))
        return p->query.space = text_of(value), 1;
    if (same_text(name, "radius") && is_number)
        return p->query.radius = first_number(value, p->query.mask), 1;
    if (same_text(name, "radiusscale") && is_number)
        return p->query.radius_scale = first_number(value, p->query.mask), 1;
    return same_text(name, "interpolate") || value->type == SL_TYPE_string ||
           value->type == SL_TYPE_matrix || value->array_length;
}

/* pair[k]: the value of channel k. */
static void take_channels(point_samples* p, const sl_value* values, int n, const sl_value** pair) {
    for (int i = 0; i + 1 < n; i += 2) {
        sl_point_query* q = &p->query;
        const sl_string name = is_text(&values[i]) ? text_of(&values[i]) : 0;
        if (!is_named(name) || take_point_option(p, name, &values[i + 1]) ||
            q->num_channels == SL_POINT_CHANNELS_MAX)
            continue;
        float* planes = p->values[q->num_channels];
        load_channel(&values[i + 1], planes);
        pair[q->num_channels] = &values[i + 1];
        q->channel[q->num_channels++] = (sl_point_channel){name, values[i + 1].type, planes};
    }
}

static void take_point_options(point_samples* p, const sl_value* values, int n) {
    for (int i = 0; i + 1 < n; i += 2)
        if (is_text(&values[i]) && is_named(text_of(&values[i])))
            take_point_option(p, text_of(&values[i]), &values[i + 1]);
}

static uint32_t bake_points(const sl_call* call, point_samples* p, const sl_value* values, int n) {
    const sl_value* pair[SL_POINT_CHANNELS_MAX];
    take_channels(p, values, n, pair);
    return call->services->bake(call->engine, &p->query);
}

static uint32_t read_points(const sl_call* call, point_samples* p, const sl_value* values, int n) {
    const sl_value* pair[SL_POINT_CHANNELS_MAX];
    take_channels(p, values, n, pair);
    const uint32_t set = call->services->texture3d(call->engine, &p->query);
    for (int k = 0; k < p->query.num_channels && set; k++)
        store_channel(pair[k], sl_mask(set), p->values[k]);
    return set;
}

static float slu_succeeded_(const sl_call* call, uint32_t lanes) {
    (void)call;
    return lanes ? 1.0f : 0.0f;
}
static slf slv_succeeded_(const sl_call* call, sli mask, uint32_t lanes) {
    (void)call;
    return slv_f_of_mask(sl_mask(lanes) & mask);
}

#define SL_BODY "maps_body.h"
#include "sl_both_worlds.h"
