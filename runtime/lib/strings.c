/* SPDX-License-Identifier: Apache-2.0
 * printf, format, concat and match; reference/sl.md 4.5. Texts are limited to TEXT_MAX bytes, so
 * that shaders that double a string in a loop stay bounded. Directives follow the value's type: any
 * of f d p v n c m s prints whatever is given, triples and matrices as numbers with spaces between,
 * with the C width and precision for each.
 */
#include "body.h"

#include <stdio.h>
#include <string.h>

enum { TEXT_MAX = 4096, DIRECTIVE_MAX = 24, FIELD_MAX = 512 };

typedef struct text {
    char bytes[TEXT_MAX];
    size_t length; /* without the final 0 */
} text;

static void append(text* t, const char* from, size_t n) {
    const size_t room = TEXT_MAX - 1 - t->length;
    n = n < room ? n : room;
    memcpy(t->bytes + t->length, from, n);
    t->length += n;
    t->bytes[t->length] = 0;
}

/* --- one directive
 * --------------------------------------------------------------------------------------------------
 */

typedef struct directive {
    char flags[DIRECTIVE_MAX]; /* "%", flags, width, precision; room for "ld" */
    int as_integer;
    const char* end; /* after the conversion letter */
} directive;

static const char* copy_digits(const char* p, char* to, size_t* n) {
    for (int digits = 0; *p >= '0' && *p <= '9'; p++, digits++)
        if (digits < 3) /* wider fields are cut to 999 */
            to[(*n)++] = *p;
    return p;
}

/* Parses what follows '%'; 0 if there is no known conversion letter. */
static int parse_directive(const char* p, directive* d) {
    size_t n = 0;
    d->flags[n++] = '%';
    for (; *p && strchr("-+ 0#", *p); p++)
        if (n < 6)
            d->flags[n++] = *p;
    p = copy_digits(p, d->flags, &n);
    if (*p == '.') {
        d->flags[n++] = *p++;
        p = copy_digits(p, d->flags, &n);
    }
    d->flags[n] = 0;
    if (!*p || !strchr("fdpvncmsgei", *p))
        return 0;
    d->as_integer = *p == 'd' || *p == 'i';
    d->end = p + 1;
    return 1;
}

/* SL floats to C integers, toward zero; NaN is 0 and huge values are the largest. */
static long long integer_of(float x) {
    const float limit = 9.2e18f;
    if (!(x == x))
        return 0;
    return (long long)(x > limit ? limit : x < -limit ? -limit : x);
}

static void append_number(text* t, const directive* d, float x) {
    char format[DIRECTIVE_MAX + 4], field[FIELD_MAX];
    snprintf(format, sizeof format, "%s%s", d->flags, d->as_integer ? "lld" : "f");
    const int n = d->as_integer ? snprintf(field, sizeof field, format, integer_of(x))
                                : snprintf(field, sizeof field, format, (double)x);
    append(t, field, n < 0 ? 0 : n < FIELD_MAX ? (size_t)n : FIELD_MAX - 1);
}

static void append_string(text* t, const directive* d, const char* s) {
    char format[DIRECTIVE_MAX + 4], field[TEXT_MAX];
    snprintf(format, sizeof format, "%ss", d->flags);
    const int n = snprintf(field, sizeof field, format, s ? s : "");
    append(t, field, n < 0 ? 0 : n < TEXT_MAX ? (size_t)n : TEXT_MAX - 1);
}

/* --- values
 * -----------------------------------------------------------------------------------------------------------
 */

static int components_of(int type) {
    return type == SL_TYPE_float ? 1 : type == SL_TYPE_matrix ? 16 : 3;
}

/* Component i (over all array elements) as lane `lane` sees it. Uniform values and lanes are both
 * dense in memory. */
static float component(const sl_value* v, int i, int lane) {
    return v->varying ? ((const slf*)v->data)[i][lane] : ((const float*)v->data)[i];
}

static sl_string string_element(const sl_value* v, int i, int lane) {
    return v->varying ? ((const sls*)v->data)[i].s[lane] : ((const sl_string*)v->data)[i];
}

static void append_value(text* t, const directive* d, const sl_value* v, int lane) {
    const int elements = v->array_length > 0 ? v->array_length : 1;
    const int is_string = v->type == SL_TYPE_string;
    const int n = is_string ? elements : elements * components_of(v->type);
    for (int i = 0; i < n && t->length + 1 < TEXT_MAX; i++) {
        if (i)
            append(t, " ", 1);
        if (is_string)
            append_string(t, d, string_element(v, i, lane));
        else
            append_number(t, d, component(v, i, lane));
    }
}

/* A directive without a value prints nothing; an unknown one is text. */
static void print_lane(text* t, const char* format, const sl_value* values, int n, int lane) {
    int next = 0;
    t->length = 0;
    t->bytes[0] = 0;
    for (const char* p = format ? format : ""; *p;) {
        directive d;
        const char* stop = strchr(p, '%');
        append(t, p, stop ? (size_t)(stop - p) : strlen(p));
        if (!stop)
            return;
        if (parse_directive(stop + 1, &d)) {
            if (next < n)
                append_value(t, &d, &values[next++], lane);
            p = d.end;
        } else {
            append(t, "%", 1);
            p = stop + (stop[1] == '%' ? 2 : 1);
        }
    }
}

static int any_varying(const sl_value* values, int n) {
    for (int i = 0; i < n; i++)
        if (values[i].varying)
            return 1;
    return 0;
}

/* --- the functions
 * ------------------------------------------------------------------------------------------------------
 */

void slu_printf(const sl_call* call, sl_string format, const sl_value* values, int n) {
    text t;
    print_lane(&t, format, values, n, sl_first_lane(call->live));
    call->services->print_uniform(call->engine, call->first, t.bytes);
}

/* Once per point, or once for all points of the batch if nothing varies (lib-009). */
void slv_printf(const sl_call* call, sli mask, sl_string format, const sl_value* values, int n) {
    text t;
    const int once = !any_varying(values, n);
    for (int lane = 0; lane < SL_LANES; lane++) {
        if (!mask[lane])
            continue;
        print_lane(&t, format, values, n, lane);
        if (once) {
            call->services->print_uniform(call->engine, call->first, t.bytes);
            return;
        }
        call->services->print(call->engine, call->first + (uint32_t)lane, t.bytes);
    }
}

sl_string slu_format(const sl_call* call, sl_string format, const sl_value* values, int n) {
    text t;
    print_lane(&t, format, values, n, sl_first_lane(call->live));
    return call->services->intern(call->engine, t.bytes);
}

sls slv_format(const sl_call* call, sli mask, sl_string format, const sl_value* values, int n) {
    text t;
    const int once = !any_varying(values, n);
    sls r = slv_spread_s(once ? slu_format(call, format, values, n) : "");
    for (int lane = 0; lane < SL_LANES && !once; lane++)
        if (mask[lane]) {
            print_lane(&t, format, values, n, lane);
            r.s[lane] = call->services->intern(call->engine, t.bytes);
        }
    return r;
}

sl_string slu_concat(const sl_call* call, const sl_string* parts, int n) {
    text t;
    t.length = 0;
    t.bytes[0] = 0;
    size_t wanted = 0;
    for (int i = 0; i < n; i++) {
        const size_t length = parts[i] ? strlen(parts[i]) : 0;
        append(&t, parts[i] ? parts[i] : "", length);
        wanted += length;
    }
    if (wanted > t.length)
        call->services->report(call->engine, 0, "concat(): the result is cut to 4095 characters");
    return call->services->intern(call->engine, t.bytes);
}

sls slv_concat(const sl_call* call, sli mask, const sl_string* parts, int n) {
    (void)mask;
    return slv_spread_s(slu_concat(call, parts, n));
}

/* The engine compiles patterns, once each. */
float slu_match(const sl_call* call, sl_string pattern, sl_string subject) {
    return call->services->match(call->engine, pattern, subject) != 0 ? 1.0f : 0.0f;
}

slf slv_match(const sl_call* call, sli mask, sl_string pattern, sl_string subject) {
    (void)mask;
    return slv_spread_f(slu_match(call, pattern, subject));
}
