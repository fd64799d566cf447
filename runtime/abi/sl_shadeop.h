/* SPDX-License-Identifier: Apache-2.0
 * Functions for shaders written in C: what a shared library (a DSO) offers to shaders that call it
 * by name. Plain C, no other header needed; docs/shadeops.md has an example.
 *
 * A DSO exports one symbol, `sl_shadeops`, the table of its functions:
 *
 *   static void hypot2(void* data, void* const* argument) {
 *       const float* x = argument[1];
 *       const float* y = argument[2];
 *       *(float*)argument[0] = sqrtf(*x * *x + *y * *y);
 *   }
 *   SL_SHADEOP_TABLE({"f hypot2(f,f)", hypot2, 0, 0})
 *
 * Signatures: result, name, arguments. Types are letters: f float, c color, p point, v vector,
 * n normal, m matrix, s string; `void` for no result. Upper case: output argument. Several rows
 * with one name are overloads; the shader's compiler picks by types, in this order.
 *
 * A function is called once for each point. argument[0] is the result (absent for void), the others
 * follow in order: a float is a float, a color, point, vector or normal three, a matrix sixteen by
 * rows, a string a `const char*`. Arguments that are no outputs must not be written; outputs hold
 * the variable's value before. A string that is set need not outlive the next call. Points, vectors
 * and normals are in "current" space.
 *
 * Contract: functions run on several threads at once and must be reentrant. The same arguments
 * should give the same result: pictures are expected not to depend on threads or buckets. Where an
 * area operator (Du, filtered texture ...) depends on a result, the function is also called for the
 * neighbouring points.
 */
#ifndef PERIGEE_SL_SHADEOP_H
#define PERIGEE_SL_SHADEOP_H

#ifdef __cplusplus
extern "C" {
#endif

enum { SL_SHADEOP_VERSION = 1, SL_SHADEOP_MAX_ARGUMENTS = 32, SL_SHADEOP_MAX_OUTPUTS = 8 };

typedef struct sl_shadeop {
    const char* signature;
    void (*function)(void* data, void* const* argument);
    /* Called once before the first call, on one thread; what it returns is `data`. May be 0. */
    void* (*init)(void);
    /* Called once at the end, if init was. May be 0. */
    void (*cleanup)(void* data);
} sl_shadeop;

typedef struct sl_shadeop_table {
    int version; /* SL_SHADEOP_VERSION */
    int num_functions;
    const sl_shadeop* functions;
} sl_shadeop_table;

#define SL_SHADEOP_TABLE(...)                                                                      \
    static const sl_shadeop sl_shadeop_rows[] = {__VA_ARGS__};                                     \
    __attribute__((visibility("default"))) const sl_shadeop_table sl_shadeops = {                  \
        SL_SHADEOP_VERSION, (int)(sizeof sl_shadeop_rows / sizeof sl_shadeop_rows[0]),             \
        sl_shadeop_rows};

#ifdef __cplusplus
}
#endif
#endif
