/* SPDX-License-Identifier: Apache-2.0
 * filterstep over an explicit interval, for both worlds.
 */
#include "body.h"

static int same_text(const char* a, const char* b) {
    while (*a && *a == *b)
        a++, b++;
    return *a == *b;
}

static const sl_value* find_option(const sl_value* values, int n, const char* name, int type) {
    for (int i = 0; i + 1 < n; i += 2)
        if (values[i].type == SL_TYPE_string && !values[i].varying && values[i + 1].type == type &&
            same_text(*(const sl_string*)values[i].data, name))
            return &values[i + 1];
    return 0;
}

/* The filter's name; NULL is the box. */
static sl_string filter_name(const sl_value* values, int n) {
    const sl_value* filter = find_option(values, n, "filter", SL_TYPE_string);
    return filter && !filter->varying ? *(const sl_string*)filter->data : 0;
}

static const sl_value* filter_width(const sl_value* values, int n) {
    const sl_value* width = find_option(values, n, "width", SL_TYPE_float);
    return width ? width : find_option(values, n, "swidth", SL_TYPE_float);
}

static float slu_number_(const sl_value* value) {
    return *(const float*)value->data;
}

static slf slv_number_(const sl_value* value) {
    return value->varying ? *(const slf*)value->data : slv_spread_f(*(const float*)value->data);
}

#define SL_BODY "filter_body.h"
#include "sl_both_worlds.h"
#define SL_BODY "diff_filter_body.h"
#include "sl_both_worlds.h"
