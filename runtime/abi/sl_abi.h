/* SPDX-License-Identifier: Apache-2.0
 * The contract between a compiled shader and the engine: plain C11, no system header but
 * <stdint.h>.
 *
 * A shader object exports one symbol, `sl_shader_object`, an sl_object with one sl_variant per
 * instruction set. A shader works on a *batch* of up to SL_BATCH_MAX points of one shader instance;
 * the engine calls `shade` once per packet of `lanes` points. Everything a shader reads and writes
 * arrives through the call, nothing is static: shaders are reentrant and objects refer to no host
 * symbol.
 *
 * Layout of per-point data: structure of arrays. A variable with c components is c planes of
 * `stride` floats; plane k of point i is base[k*stride + i]. Bases are 64-byte aligned and stride
 * is a multiple of 8, so that a packet may read and write whole vectors; lanes beyond `count` hold
 * harmless values and are masked.
 *
 * Spaces: every point, vector and normal a shader sees is in "current" space, which is camera
 * space.
 */
#ifndef PERIGEE_SL_ABI_H
#define PERIGEE_SL_ABI_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { SL_BATCH_MAX = 256, SL_LANES_MAX = 8 };

/* An interned, immutable, NUL-terminated string: equal texts have equal pointers. */
typedef const char* sl_string;

typedef enum sl_type {
    SL_TYPE_void,
    SL_TYPE_float,
    SL_TYPE_color,
    SL_TYPE_point,
    SL_TYPE_vector,
    SL_TYPE_normal,
    SL_TYPE_matrix,
    SL_TYPE_string
} sl_type;

typedef enum sl_detail { SL_DETAIL_uniform, SL_DETAIL_varying } sl_detail;

typedef enum sl_shader_type {
    SL_SHADER_surface,
    SL_SHADER_displacement,
    SL_SHADER_light,
    SL_SHADER_volume,
    SL_SHADER_imager,
    SL_SHADER_transformation
} sl_shader_type;

/* Shader types as bits, for the tables. */
enum { SL_IN_S = 1, SL_IN_D = 2, SL_IN_L = 4, SL_IN_V = 8, SL_IN_I = 16, SL_IN_T = 32 };

/* Ids of the predefined variables; bit (1 << id) in needed and written masks. */
typedef enum sl_variable {
#define SL_VAR(name, type, detail, readable, writable, note) SL_VAR_##name,
#include "sl_variables.def"
#undef SL_VAR
    SL_VAR_COUNT
} sl_variable;

/* ShaderVariables of a batch. var[id] is NULL unless the needed or written mask has the bit.
 * Uniform variables hold one value per component, without planes (component k at base[k]). */
typedef struct sl_points {
    float* var[SL_VAR_COUNT];
} sl_points;

enum { SL_RAY_camera, SL_RAY_reflection, SL_RAY_shadow, SL_RAY_diffuse };

enum {
    SL_MESSAGE_lightsource,
    SL_MESSAGE_surface,
    SL_MESSAGE_displacement,
    SL_MESSAGE_atmosphere,
    SL_MESSAGE_incident,
    SL_MESSAGE_opposite,
    SL_MESSAGE_attribute,
    SL_MESSAGE_option,
    SL_MESSAGE_rendererinfo,
    SL_MESSAGE_ray /* rayinfo(): of the ray that came here */
};

/* A typed reference to a value of a running shader, for printf, options, outputs of any type and
 * shadeops. data: array_length (or one) consecutive values: one per component (strings: one
 * pointer) or, with `varying`, one plane of a packet's lanes per component (strings: one pointer
 * per lane). */
typedef struct sl_value {
    int32_t type; /* sl_type */
    int32_t varying;
    int32_t array_length; /* 0: not an array */
    void* data;
} sl_value;

/* One light asked about the points of one packet. */
typedef struct sl_light_query {
    int32_t index;  /* 0 .. light_count()-1 */
    uint32_t first; /* batch index of lane 0 */
    uint32_t lanes; /* plane length of all pointers here */
    uint32_t mask;  /* lanes asked */
    const float* P; /* points being lit, 3 planes */
    const float* N; /* normal there, 3 planes, or NULL: the batch's N if it has one */
    const float*
        axis; /* 3 planes, or NULL: all directions. Lanes outside the cone are not lit ... */
    const float* cosangle; /* ... 1 plane: cos of the half angle */
    sl_string category;    /* "" = all lights */
    int32_t sample;        /* samples of this light the loop has had already (area lights) */
    int32_t refresh;       /* non-zero: run the light, whatever is known ("lightcache" "refresh") */
    int32_t num_sends;     /* values the light's parameters have in this execution ... */
    const sl_value* sends; /* ... as pairs: name (uniform string), value ("send:light:name") */
} sl_light_query;

/* What arrives there. The engine runs the light, applies shadows, negates L. */
typedef struct sl_light_result {
    float L[3 * SL_LANES_MAX]; /* from P towards the light; planes of query->lanes */
    float Cl[3 * SL_LANES_MAX];
    float Ol[3 * SL_LANES_MAX];
    float nondiffuse[SL_LANES_MAX];  /* the light's __nondiffuse, 0 if it has none */
    float nonspecular[SL_LANES_MAX]; /* the light's __nonspecular */
    int32_t
        more; /* non-zero: another sample of this light follows (area lights): ask again with the
                 same index; the engine scales Cl so that the sum over samples is the light */
    int32_t next; /* when no sample follows: the next light worth asking; not above the query's
                     index: the one after it. Lights between are left out; those asked make up for
                     them in Cl */
} sl_light_result;

/* What a map lookup asks for, and the slots of its options. */
enum {
    SL_MAP_texture,
    SL_MAP_environment,
    SL_MAP_shadow,
    SL_MAP_bump,      /* result: derivatives by s and t */
    SL_MAP_occlusion, /* at: point, du: unit normal; the share of a set of shadow maps that is dark
                       */
    SL_MAP_irradiance /* at: unit normal; cosine-weighted mean of an environment */
};
enum {
#define SL_MAP_SLOT(name, default, note) SL_MAP_OPTION_##name,
#include "sl_map_options.def"
    SL_MAP_OPTIONS
};

/* One lookup for the points of one packet. at, du and dv are planes of `lanes`: s and t for
 * textures and bump maps, else three components. du and dv are the differences to the auxiliary
 * points and span the footprint. */
typedef struct sl_map_query {
    int32_t kind;                  /* SL_MAP_* */
    int32_t channel, num_channels; /* the first one, and how many */
    uint32_t first, lanes, mask;
    sl_string filter; /* NULL: not given */
    uint32_t given;   /* bit (1 << SL_MAP_OPTION_*): option was given, else it holds its default */
    sl_string name[SL_LANES_MAX];
    float at[3 * SL_LANES_MAX];
    float du[3 * SL_LANES_MAX];
    float dv[3 * SL_LANES_MAX];
    float option[SL_MAP_OPTIONS][SL_LANES_MAX];
} sl_map_query;

enum { SL_POINT_CHANNELS_MAX = 16 };

typedef struct sl_point_channel {
    sl_string name;
    int32_t type;  /* SL_TYPE_float, or one of three components */
    float* values; /* planes of `lanes` */
} sl_point_channel;

/* Samples of bake() (at: s and t), bake3d() and texture3d() (at: P, then N). */
typedef struct sl_point_query {
    sl_string file;
    int32_t num_at; /* planes of at: 2 or 6 */
    uint32_t first, lanes, mask;
    const float* at;
    sl_string space; /* coordinate system of the file; NULL: world */
    float radius;    /* bake3d: of the sample, texture3d: search; 0: not given */
    float radius_scale;
    int32_t num_channels;
    sl_point_channel channel[SL_POINT_CHANNELS_MAX];
} sl_point_query;

/* Where a shader's time goes, by places of its source: one row for each sl_place of the object.
 * Ticks are those of the processor's counter, from a place to the next one. */
typedef struct sl_profile_row {
    uint64_t ticks;
    uint64_t packets; /* times a packet came here */
    uint64_t lanes;   /* live lanes of those packets */
} sl_profile_row;

typedef struct sl_place {
    const char* file;
    int32_t line; /* 0: before and after the shader's own statements */
} sl_place;

/* What functions that trace rays ask for. */
enum {
    SL_RAYS_trace,        /* colour from along D */
    SL_RAYS_fulltrace,    /* also what was hit, and the deepest ray that missed */
    SL_RAYS_hittest,      /* what was hit; nothing is shaded */
    SL_RAYS_transmission, /* share of light that passes from P to D, a point */
    SL_RAYS_shadow,       /* the same from P to P + D, or along D to infinity in lights that shine
                             from there: shadow("raytrace", P) */
    SL_RAYS_occlusion,    /* D: normal; C[0]: share of the cone about it that is covered */
    SL_RAYS_indirect,     /* D: normal; mean colour from the cone about it */
    SL_RAYS_gather        /* ray number `sample` of `samples` in the cone of `angle` about D */
};
enum {
#define SL_RAY_NUMBER(name, default, note) SL_RAY_OPTION_##name,
#include "sl_ray_options.def"
    SL_RAY_OPTIONS
};
enum {
#define SL_RAY_TEXT(name, note) SL_RAY_TEXT_##name,
#include "sl_ray_options.def"
    SL_RAY_TEXTS
};
enum { SL_RAY_CHANNELS_MAX = 16 };

/* A value at the hit that is asked for ("surface:Ci", "ray:length", "primitive:N"), or one sent
 * there ("send:surface:Kd"): floats and triples; a matrix or string cannot be asked for. The rays'
 * own outputs of occlusion() and indirectdiffuse() ("environmentdir", "occlusion") are channels,
 * too. */
typedef struct sl_ray_channel {
    sl_string name;
    int32_t type; /* SL_TYPE_float, or one of three components */
    int32_t is_sent;
    uint32_t set;                   /* lanes the engine has set */
    float values[3 * SL_LANES_MAX]; /* planes of `lanes` */
} sl_ray_channel;

/* Rays of one packet: the question, then the answer. Where a shader may wait, it stands in its
 * frame and the shader returns SL_SUSPENDED; elsewhere the service `rays` answers at once. Planes
 * of `lanes`; points and directions are in current space, directions need not be unit. */
typedef struct sl_ray_query {
    int32_t kind; /* SL_RAYS_* */
    uint32_t first, lanes, mask;
    float P[3 * SL_LANES_MAX];
    float D[3 * SL_LANES_MAX];
    /* Differences of both at the auxiliary points, the rays' footprint; 0 where there are none. */
    float P_u[3 * SL_LANES_MAX], P_v[3 * SL_LANES_MAX];
    float D_u[3 * SL_LANES_MAX], D_v[3 * SL_LANES_MAX];
    float angle[SL_LANES_MAX];
    int32_t sample, samples; /* gather */
    sl_string category;      /* gather */
    uint32_t given;          /* bit (1 << SL_RAY_OPTION_*): was given, else holds its default */
    float option[SL_RAY_OPTIONS][SL_LANES_MAX];
    sl_string text[SL_RAY_TEXTS];
    int32_t num_channels;
    sl_ray_channel channel[SL_RAY_CHANNELS_MAX];

    uint32_t hit;                 /* lanes whose ray met a surface */
    float C[3 * SL_LANES_MAX];    /* colour, transmission; a number in the first plane */
    float distance[SL_LANES_MAX]; /* in units of length; 1e30 where nothing was hit */
    float Phit[3 * SL_LANES_MAX], Nhit[3 * SL_LANES_MAX];
    float Pmiss[3 * SL_LANES_MAX], Rmiss[3 * SL_LANES_MAX];
    float level_missed[SL_LANES_MAX]; /* level of the deepest ray that missed; 0: none did */
} sl_ray_query;

typedef struct sl_services {
#define SL_SERVICE(name, result, arguments, note) result(*name) arguments;
#include "sl_services.def"
#undef SL_SERVICE
} sl_services;

typedef enum sl_status { SL_DONE = 0, SL_SUSPENDED = 1 } sl_status;

/* Head of every packet frame. `state` 0 starts the shader; the rest is the shader's own. */
typedef struct sl_frame {
    int32_t state;
    int32_t reserved;
    sl_ray_query rays; /* what it waits for while it is suspended */
} sl_frame;

/* One batch. `params` follows sl_param.offset. Differences, not values, for the two auxiliary
 * points: aux_u holds X(u+du,v) - X(u,v), aux_v X(u,v+dv) - X(u,v), computed free of cancellation.
 * Planes of the variables in needed_aux and written_aux; where the engine has none (a NULL record
 * or plane) differences are 0 and results are not stored. du and dv (main) are the steps; either
 * may be negative, neither is 0. */
typedef struct sl_batch {
    const sl_points* main;
    const sl_points* aux_u;
    const sl_points* aux_v;
    void* params;
    const sl_string* strings; /* the object's literals, interned by the loader */
    const sl_services* services;
    void* engine;
    const uint32_t* seed; /* per point: source of random(), a function of pixel and sample only */
    uint32_t count;       /* points in the batch */
    uint32_t stride;      /* floats per plane */
    uint32_t* lit;        /* lights: [packet] lanes that executed illuminate or solar */
} sl_batch;

/* Parameter block: offsets in bytes, 16-byte aligned slots.
 * uniform numeric: array_length*components floats; uniform string: sl_string each.
 * varying numeric: `float *` to array_length*components planes of `stride`; varying string:
 * `sl_string *`. Output parameters: initialised by the engine with the bound value before every
 * execution. */
typedef struct sl_param {
    const char* name;
    int32_t type;         /* sl_type */
    int32_t detail;       /* sl_detail */
    int32_t array_length; /* 0: not an array */
    int32_t is_output;
    uint32_t offset;
    int32_t needs_aux; /* varying numeric: after the planes of the values follow as many with the
                          differences to u+du, then as many with those to v+dv; inputs only */
} sl_param;

/* What default expressions are evaluated with, once per instance. */
typedef struct sl_init {
    void* params;
    const uint8_t* bound; /* per parameter: 1 if the caller already stored a value */
    const sl_string* strings;
    const sl_services* services;
    void* engine;
} sl_init;

enum { SL_ISA_any = 0, SL_ISA_avx2 = 1 };

typedef struct sl_variant {
    int32_t isa;
    int32_t lanes;
    uint32_t frame_size; /* bytes of one packet frame, sl_frame included; 0: never suspends, frame
                            may be NULL */
    uint32_t frame_align;
    /* Shades points first .. first+lanes-1; count_in_packet of them are real. */
    sl_status (*shade)(const sl_batch* batch, uint32_t first, uint32_t count_in_packet,
                       sl_frame* frame);
    /* Stores the default of every parameter that is not bound. Varying parameters: the default goes
     * to the uniform staging slot `offset + 16` of their pointer slot, for the engine to spread. */
    void (*init)(const sl_init* init);
} sl_variant;

/* Facts the analysis found; the engine computes, groups and schedules by them. */
enum {
    SL_FACT_lights = 1,  /* runs light shaders */
    SL_FACT_ambient = 2, /* calls ambient() */
    SL_FACT_directional =
        4, /* light: contains illuminate or solar, so it is not an ambient light */
    SL_FACT_area_operators = 8, /* reads aux_u, aux_v or differences of parameters */
    SL_FACT_traces = 16,        /* may suspend for trace() and its relatives */
    SL_FACT_textures = 32,
    SL_FACT_object_space = 64, /* names a space that depends on the primitive: batch by transform */
    SL_FACT_attributes = 128,  /* attribute() or shader messages: batch by attribute state */
    SL_FACT_random = 256,      /* needs seed */
    SL_FACT_solar = 512,       /* light: contains solar */
    SL_FACT_writes_opacity = 1024,
    SL_FACT_shader_space = 2048 /* names "shader" space: depends on the place of the call */
};

/* The one exported symbol: `const sl_object sl_shader_object`. */
typedef struct sl_object {
    const char* fingerprint; /* SL_ABI_FINGERPRINT of the compiler that made it; first, so that it
                                can be checked before anything else is read */
    const char* name;
    int32_t type; /* sl_shader_type */
    int32_t num_params;
    const sl_param* params;
    uint32_t params_size; /* bytes of the parameter block */
    uint32_t facts;
    uint64_t needed;      /* variables that must be filled */
    uint64_t written;     /* variables the shader may change */
    uint64_t needed_aux;  /* variables whose differences at the auxiliary points are read */
    uint64_t written_aux; /* displacement: variables (of P, N, s, t) whose differences it stores to
                             aux_u and aux_v: those that differ from what it was given */
    int32_t num_strings;
    const char* const* strings; /* literals, to be interned by the loader */
    int32_t num_variants;
    const sl_variant* const* variants; /* best first */
    const char* ir;                    /* IR text, for specialisation and --explain */
    const char* source;                /* name of the source file */
    int32_t num_places;                /* compiled for profiles: places of sl_profile_row; else 0 */
    const sl_place* places;
} sl_object;

#ifdef __cplusplus
}
#endif
#endif
