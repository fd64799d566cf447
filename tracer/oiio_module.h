/* SPDX-License-Identifier: Apache-2.0
 * Between the program and perigee_oiio.so, which holds OpenImageIO: a C function, so that neither
 * side depends on the other's C++ library. In: pixels and what the file says about them. Out: the
 * bytes of the file, through a callback; the program gives them their name. */
#ifndef PERIGEE_OIIO_MODULE_H
#define PERIGEE_OIIO_MODULE_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct perigee_oiio_picture {
    const char* suffix; /* of the format, without the dot */
    int width, height, num_channels;
    int x, y, frame_width, frame_height; /* place of the pixels in the frame */
    int bits;                            /* 8, 16: unsigned; 32: float */
    int alpha;                           /* channel, or -1 */
    int alpha_divided;                   /* colors were divided by alpha */
    float pixel_aspect;
    const char* compression;        /* "" = the format's default */
    int quality;                    /* 0..100 */
    const float* camera_from_world; /* 16, row vectors; the next one as well */
    const float* screen_from_world; /* screen: a square from -1 to 1, y up */
    const void* pixels;             /* rows from the top, channels interleaved */
} perigee_oiio_picture;

/* Takes bytes of the file in order; 0: stop. */
typedef int (*perigee_oiio_sink)(void* user, const void* bytes, size_t count);

/* 1 on success; else 0 and text in error. Catches everything. */
typedef int (*perigee_oiio_write_function)(const perigee_oiio_picture*, perigee_oiio_sink,
                                           void* user, char* error, size_t error_size);
#define PERIGEE_OIIO_WRITE "perigee_oiio_write"

#ifdef __cplusplus
}
#endif
#endif
