/* SPDX-License-Identifier: Apache-2.0
 * Colour spaces for both worlds.
 */
#include "body.h"

enum { SPACE_RGB, SPACE_HSV, SPACE_HSL, SPACE_YIQ, SPACE_XYZ, SPACE_XYY };

static int same_text(const char* a, const char* b) {
    while (*a && *a == *b)
        a++, b++;
    return *a == *b;
}

/* Unknown names count as rgb (slc checks literals). */
static int colour_space(sl_string name) {
    static const struct {
        const char* name;
        int space;
    } names[] = {{"rgb", SPACE_RGB}, {"hsv", SPACE_HSV}, {"hsl", SPACE_HSL}, {"YIQ", SPACE_YIQ},
                 {"xyz", SPACE_XYZ}, {"XYZ", SPACE_XYZ}, {"CIE", SPACE_XYZ}, {"xyY", SPACE_XYY}};
    for (unsigned i = 0; name && i < sizeof names / sizeof names[0]; i++)
        if (same_text(name, names[i].name))
            return names[i].space;
    return SPACE_RGB;
}

#define SL_BODY "colour_body.h"
#include "sl_both_worlds.h"
#define SL_BODY "diff_colour_body.h"
#include "sl_both_worlds.h"
