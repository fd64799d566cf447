/* SPDX-License-Identifier: Apache-2.0
 * Calls of functions of DSOs through the engine (docs/shadeops.md): objects refer to no host
 * symbol. One body per number of outputs; the result, if there is one, is the first of them. Lanes
 * outside the mask keep what they have.
 */
#include "body.h"

enum { MOST_OUTPUTS = 8 };

static void ask(const sl_call* call, uint32_t mask, sl_string function,
                const sl_value* const* outputs, int num_outputs, const sl_value* values, int n) {
    sl_value out[MOST_OUTPUTS] = {{0}};
    for (int i = 0; i < num_outputs; i++)
        out[i] = *outputs[i];
    call->services->shadeop(call->engine, function, call->first, mask, out, num_outputs, values, n);
}

/* clang-format off */
#define SHADEOP(n, formals, ...)                                                                   \
    void slu_shadeop_##n(const sl_call* call, sl_string function, formals                          \
                         const sl_value* values, int num) {                                        \
        const sl_value* const outputs[] = {__VA_ARGS__};                                           \
        ask(call, 1u << sl_first_lane(call->live), function, outputs, n, values, num);             \
    }                                                                                              \
    void slv_shadeop_##n(const sl_call* call, sli mask, sl_string function, formals                \
                         const sl_value* values, int num) {                                        \
        const sl_value* const outputs[] = {__VA_ARGS__};                                           \
        if (sl_any(mask))                                                                          \
            ask(call, sl_bits(mask), function, outputs, n, values, num);                           \
    }
#define O(name) const sl_value* name,
SHADEOP(0, , 0)
SHADEOP(1, O(a), a)
SHADEOP(2, O(a) O(b), a, b)
SHADEOP(3, O(a) O(b) O(c), a, b, c)
SHADEOP(4, O(a) O(b) O(c) O(d), a, b, c, d)
SHADEOP(5, O(a) O(b) O(c) O(d) O(e), a, b, c, d, e)
SHADEOP(6, O(a) O(b) O(c) O(d) O(e) O(f), a, b, c, d, e, f)
SHADEOP(7, O(a) O(b) O(c) O(d) O(e) O(f) O(g), a, b, c, d, e, f, g)
SHADEOP(8, O(a) O(b) O(c) O(d) O(e) O(f) O(g) O(h), a, b, c, d, e, f, g, h)
