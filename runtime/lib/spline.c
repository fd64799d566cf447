/* SPDX-License-Identifier: Apache-2.0
 * Splines and their inverse for both worlds.
 */
#include "body.h"

typedef struct basis {
    const char* name;
    int step;    /* knots from one segment to the next */
    float m[16]; /* [t^3 t^2 t 1] m [k0 k1 k2 k3]; sl.md 4.1.2 */
} basis;

#define SIXTH 0.166666667f
static const basis bases[] = {
    {"catmull-rom", 1, {-.5f, 1.5f, -1.5f, .5f, 1, -2.5f, 2, -.5f, -.5f, 0, .5f, 0, 0, 1, 0, 0}},
    {"bspline",
     1,
     {-SIXTH, .5f, -.5f, SIXTH, .5f, -1, .5f, 0, -.5f, 0, .5f, 0, SIXTH, 4 * SIXTH, SIXTH, 0}},
    {"b-spline",
     1,
     {-SIXTH, .5f, -.5f, SIXTH, .5f, -1, .5f, 0, -.5f, 0, .5f, 0, SIXTH, 4 * SIXTH, SIXTH, 0}},
    {"bezier", 3, {-1, 3, -3, 1, 3, -6, 3, 0, -3, 3, 0, 0, 1, 0, 0, 0}},
    {"hermite", 2, {2, 1, -2, 1, -3, -2, 3, -1, 0, 1, 0, 0, 1, 0, 0, 0}},
    {"linear", 1, {0, 0, 0, 0, 0, 0, 0, 0, 0, -1, 1, 0, 0, 1, 0, 0}},
    {"power", 4, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}},
};

static int same_text(const char* a, const char* b) {
    while (*a && *a == *b)
        a++, b++;
    return *a == *b;
}

/* NULL, "" and unknown names are catmull-rom (slc warns about unknown literals). "solve" in front
 * asks for the inverse. */
static const basis* find_basis(sl_string name, int* inverse) {
    static const char solve[] = "solve";
    int i = 0;
    while (name && i < 5 && name[i] == solve[i])
        i++;
    *inverse = i == 5;
    if (*inverse)
        name += 5;
    for (unsigned k = 0; name && k < sizeof bases / sizeof bases[0]; k++)
        if (same_text(name, bases[k].name))
            return &bases[k];
    return &bases[0];
}

#define SL_BODY "spline_body.h"
#include "sl_both_worlds.h"
#define SL_BODY "diff_spline_body.h"
#include "sl_both_worlds.h"
#include "spline_shared.h"
