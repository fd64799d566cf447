/* SPDX-License-Identifier: Apache-2.0
 * Between the program and perigee_oiio.so, which holds OpenImageIO's TextureSystem: a table of C
 * functions, so that neither side depends on the other's C++ library. Lookups go over by packets.
 * Functions catch everything; those that take `error` say there why they failed. */
#ifndef PERIGEE_TEXTURE_MODULE_H
#define PERIGEE_TEXTURE_MODULE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { PERIGEE_TEXTURE_LANES = 8 };

enum { PERIGEE_WRAP_black, PERIGEE_WRAP_clamp, PERIGEE_WRAP_periodic, PERIGEE_WRAP_mirror };

/* Filter within a mip level where it is magnified. */
enum { PERIGEE_FILTER_linear, PERIGEE_FILTER_cubic };

typedef struct perigee_texture_info {
    int width, height, num_channels;
    int alpha;        /* channel, or -1 */
    int wrap[2];      /* PERIGEE_WRAP_*; black unless the file says otherwise */
    char format[32];  /* "Plain Texture", "LatLong Environment" ...; "" = a picture */
    int has_matrices; /* the two below are the file's */
    float camera_from_world[16], screen_from_world[16];
} perigee_texture_info;

typedef struct perigee_texture_query {
    void* file;
    uint32_t mask;
    int channel, num_channels; /* within the file's */
    int filter;
    int wrap[2];
    const float *s, *t;                     /* per lane */
    const float *dsdu, *dtdu, *dsdv, *dtdv; /* widths are multiplied in */
    const float *sblur, *tblur;
    float* result;      /* planes of PERIGEE_TEXTURE_LANES */
    float *by_s, *by_t; /* derivatives of the first channel, or NULL */
} perigee_texture_query;

typedef struct perigee_texture_stats {
    uint64_t tile_bytes; /* held now */
    uint64_t bytes_read; /* from files */
} perigee_texture_stats;

/* A picture in memory: rows from the top, channels interleaved. */
typedef struct perigee_pixels {
    int width, height, num_channels;
    float* values;
} perigee_pixels;

typedef struct perigee_make {
    const char* kind; /* "texture", "latlong" */
    const char* picture;
    const perigee_pixels* pixels; /* or this instead of a file */
    const char* smode;            /* black, periodic, clamp */
    const char* tmode;
    const char* filter; /* for the mip levels: a name of OpenImageIO; "" = box */
    const char* format; /* of the values: "" = the picture's; uint8, uint16, half, float */
    const char* compression;
    int resize; /* to powers of two */
    int mipmap;
} perigee_make;

typedef int (*perigee_byte_sink)(void* user, const void* bytes, size_t count);

typedef struct perigee_textures {
    void* (*create)(char* error, size_t error_size);
    void (*destroy)(void* system);
    void (*set_memory)(void* system, float megabytes);
    /* NULL: not readable. */
    void* (*open)(void* system, const char* path, perigee_texture_info* info, char* error,
                  size_t error_size);
    /* The file, or every file (NULL), may have changed on disk. */
    void (*invalidate)(void* system, const char* path);
    /* 0: some lane failed and holds 0. */
    int (*lookup)(void* system, const perigee_texture_query* query, char* error, size_t error_size);
    void (*stats)(void* system, perigee_texture_stats* out);
    /* Reads a whole picture of at most max_values numbers; values are freed by free_pixels. */
    int (*read)(const char* path, size_t max_values, perigee_pixels* out, char* error,
                size_t error_size);
    void (*free_pixels)(perigee_pixels* pixels);
    int (*make)(const perigee_make* what, perigee_byte_sink sink, void* user, char* error,
                size_t error_size);
} perigee_textures;

typedef const perigee_textures* (*perigee_textures_function)(void);
#define PERIGEE_OIIO_TEXTURES "perigee_oiio_textures"

#ifdef __cplusplus
}
#endif
#endif
