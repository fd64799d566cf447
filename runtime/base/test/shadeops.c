/* SPDX-License-Identifier: Apache-2.0
 * A DSO with functions for shaders: the example of docs/shadeops.md, and what the tests need.
 */
#include "runtime/abi/sl_shadeop.h"

#include <stdio.h>
#include <stdlib.h>

/* f(f,f) */
static void sum_f(void* data, void* const* argument) {
    const float* a = argument[1];
    const float* b = argument[2];
    (void)data;
    *(float*)argument[0] = *a + *b;
}

/* c(c,c) */
static void sum_c(void* data, void* const* argument) {
    const float* a = argument[1];
    const float* b = argument[2];
    float* result = argument[0];
    (void)data;
    for (int k = 0; k < 3; k++)
        result[k] = a[k] + b[k];
}

/* Turns a point by the matrix that init made; the squared length comes back too. */
static void turn(void* data, void* const* argument) {
    const float* m = data;
    const float* p = argument[1];
    float* result = argument[0];
    float* squared = argument[2];
    *squared = 0;
    for (int k = 0; k < 3; k++) {
        result[k] = p[0] * m[k] + p[1] * m[3 + k] + p[2] * m[6 + k];
        *squared += p[k] * p[k];
    }
}

static void* turn_init(void) {
    static const float quarter[9] = {0, 1, 0, -1, 0, 0, 0, 0, 1};
    float* m = malloc(sizeof quarter);
    for (int k = 0; m && k < 9; k++)
        m[k] = quarter[k];
    return m;
}

static void turn_cleanup(void* data) {
    free(data);
}

/* void(s,f,S): texts in and out. */
static void label(void* data, void* const* argument) {
    static _Thread_local char text[64]; /* need not outlive the next call */
    const char* const* name = argument[0];
    const float* number = argument[1];
    const char** result = argument[2];
    (void)data;
    snprintf(text, sizeof text, "%s%g", *name, (double)*number);
    *result = text;
}

/* clang-format off */
SL_SHADEOP_TABLE(
    {"f dsosum(f,f)", sum_f, 0, 0},
    {"c dsosum(c,c)", sum_c, 0, 0},
    {"p dsoturn(p,F)", turn, turn_init, turn_cleanup},
    {"void dsolabel(s,f,S)", label, 0, 0},
    {"x dsobroken(f)", sum_f, 0, 0})
/* clang-format on */

/* The older form: a table named after the function, values by position, the result first. */
struct spec {
    const char *definition, *init, *shutdown;
};
#define EXPORT __attribute__((visibility("default")))
EXPORT const struct spec dsoscale_shadeops[] = {{"float dsoscale_f (float, float)", "", ""},
                                                {"color dsoscale_c (color, float)", "", ""},
                                                {"", "", ""}};

EXPORT int dsoscale_f(void* data, int count, void** argument) {
    (void)data, (void)count;
    *(float*)argument[0] = *(const float*)argument[1] * *(const float*)argument[2];
    return 0;
}

EXPORT int dsoscale_c(void* data, int count, void** argument) {
    (void)data, (void)count;
    for (int k = 0; k < 3; k++)
        ((float*)argument[0])[k] = ((const float*)argument[1])[k] * *(const float*)argument[2];
    return 0;
}
