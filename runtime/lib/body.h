/* SPDX-License-Identifier: Apache-2.0
 * Shorthand for the texts of built-in bodies; they are included once per world (sl_world.h) by the
 * .c file of the same name. Bodies follow what OpenCL C also allows: no double, no recursion, no
 * pointers to pointers.
 */
#ifndef PERIGEE_LIB_BODY_H
#define PERIGEE_LIB_BODY_H

#include "sl_shader.h"

#define K(x)         FN(spread_f)(x)
#define KI(i)        FN(spread_i)(i)
#define SEL(m, a, b) FN(select_f)(m, a, b)
#define LT(a, b)     FN(lt_f)(a, b)
#define LE(a, b)     FN(le_f)(a, b)
#define EQ(a, b)     FN(eq_f)(a, b)
#define BITS(x)      FN(bits_of_f)(x)
#define FLOAT(i)     FN(f_of_bits)(i)

#define SL_PI      3.14159265358979324f
#define SL_HALF_PI 1.57079632679489662f

#endif
