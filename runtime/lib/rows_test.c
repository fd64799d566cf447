/* SPDX-License-Identifier: Apache-2.0
 * Every row of sl_builtins.def has a body in both worlds: a missing one does not link. Also the
 * compile test of the header as plain C11.
 */
#include "sl_shader.h"

#include <stdio.h>

typedef void (*body_function)(void);

static const struct {
    const char* name;
    body_function uniform, lanes;
} rows[] = {
#define SL_BUILTIN(name, signature, body, reads, properties, note)                                 \
    {#name, (body_function)slu_##body, (body_function)slv_##body},
#include "sl_builtins.def"
#undef SL_BUILTIN
};

int main(void) {
    int missing = 0;
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++)
        missing += !rows[i].uniform || !rows[i].lanes;
    printf("%u rows, %d missing\n", (unsigned)(sizeof rows / sizeof rows[0]), missing);
    return missing != 0;
}
