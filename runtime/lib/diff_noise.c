/* SPDX-License-Identifier: Apache-2.0
 * Differences of the noise family for both worlds. An object of their own, so that shaders without
 * area operators link only noise.c.
 */
#include "noise_gradients.h"

#define SL_BODY "noise_lattice.h"
#include "sl_both_worlds.h"
#define SL_BODY "diff_noise_body.h"
#include "sl_both_worlds.h"
