/* SPDX-License-Identifier: Apache-2.0
 * Differences of the noise family (noise_lattice.h), one text per world; included by diff_noise.c.
 * Within a cell noise is a polynomial: its value and its changes by two steps u and v are carried
 * together through the sums over the corners, so that one hash of the lattice serves all three and
 * steps enter as factors, never as the difference of two positions. A step that leaves the cell and
 * is longer than NEAR_STEP is the difference of two values; a shorter one continues the polynomial,
 * which agrees with its neighbour up to the third order. What holds for all: sl_diff_inline.h.
 */

/* Continuing the polynomial errs by about 10 d^3, a difference of two values by 6e-8: at 2^-9 both
 * are below 1e-4 of the difference. */
#define NEAR_STEP 0x1p-9f
/* From this length on two values are subtracted in any case: they differ enough (6e-8 of 2^-7 is
 * 8e-6), and where all lanes step that far they cost less. */
#define LONG_STEP 0x1p-7f

/* The loops over axes must vanish, so that axes live in registers. */
#define NOISE_UNROLL _Pragma("GCC unroll 4")

/* A number, and how it changes with the steps u and v. */
typedef struct FN(three_) {
    F at, u, v;
} FN(three_);

SL_INLINE FN(three_) FN(three_of_)(F at, F u, F v) {
    FN(three_) r;
    r.at = at, r.u = u, r.v = v;
    return r;
}

/* An axis of the lattice: hashes of the two corners, offset from the lower one, blending weight. */
typedef struct FN(axis3_) {
    I lower, upper;
    FN(three_) f, w;
} FN(axis3_);

/* fade(f + d) - fade(f), with p = m (1 - m) at the middle m of the step: an integral of even
 * powers. */
SL_INLINE F FN(fade_change_)(F f, F d) {
    const F m = f + 0.5f * d, p = m * (1.0f - m), h2 = 0.25f * d * d;
    return 30.0f * d * (p * p + h2 * (0.333333333f - 2.0f * p + 0.2f * h2));
}

SL_INLINE FN(axis3_) FN(moving_axis_)(FN(axis_) x, F u, F v) {
    FN(axis3_) r;
    r.lower = x.lower, r.upper = x.upper;
    r.f = FN(three_of_)(x.f, u, v);
    r.w = FN(three_of_)(x.w, FN(fade_change_)(x.f, u), FN(fade_change_)(x.f, v));
    return r;
}

/* a + w (b - a) */
SL_INLINE FN(three_) FN(blend3_)(FN(three_) w, FN(three_) a, FN(three_) b) {
    const F rise = b.at - a.at;
    return FN(three_of_)(a.at + w.at * rise, a.u + (w.u * rise + (w.at + w.u) * (b.u - a.u)),
                         a.v + (w.v * rise + (w.at + w.v) * (b.v - a.v)));
}

SL_INLINE FN(three_) FN(less_one_)(FN(three_) x) {
    return FN(three_of_)(x.at - 1.0f, x.u, x.v);
}

/* --- corners: the gradient times offset and steps
 * ----------------------------------------------------------------- */

SL_INLINE FN(three_) FN(corner3_1_)(I h, uint32_t c, FN(three_) x) {
    return FN(three_of_)(FN(corner_1_)(h, c, x.at), FN(corner_1_)(h, c, x.u),
                         FN(corner_1_)(h, c, x.v));
}
SL_INLINE FN(three_) FN(corner3_2_)(I h, uint32_t c, FN(three_) x, FN(three_) y) {
    return FN(three_of_)(FN(corner_2_)(h, c, x.at, y.at), FN(corner_2_)(h, c, x.u, y.u),
                         FN(corner_2_)(h, c, x.v, y.v));
}
SL_INLINE FN(three_) FN(corner3_3_)(I h, uint32_t c, FN(three_) x, FN(three_) y, FN(three_) z) {
    return FN(three_of_)(FN(corner_3_)(h, c, x.at, y.at, z.at), FN(corner_3_)(h, c, x.u, y.u, z.u),
                         FN(corner_3_)(h, c, x.v, y.v, z.v));
}
SL_INLINE FN(three_)
    FN(corner3_4_)(I h, uint32_t c, FN(three_) x, FN(three_) y, FN(three_) z, FN(three_) t) {
    return FN(three_of_)(FN(corner_4_)(h, c, x.at, y.at, z.at, t.at),
                         FN(corner_4_)(h, c, x.u, y.u, z.u, t.u),
                         FN(corner_4_)(h, c, x.v, y.v, z.v, t.v));
}

/* --- sums over the corners of a cell, as in noise_lattice.h
 * ---------------------------------------------------------- */

SL_INLINE FN(three_) FN(sum3_1_)(const FN(axis3_) * x, uint32_t c) {
    return FN(blend3_)(x->w, FN(corner3_1_)(x->lower, c, x->f),
                       FN(corner3_1_)(x->upper, c, FN(less_one_)(x->f)));
}

SL_INLINE FN(three_) FN(row3_2_)(const FN(axis3_) * x, I hash, FN(three_) y, uint32_t c) {
    return FN(blend3_)(x->w, FN(corner3_2_)(x->lower ^ hash, c, x->f, y),
                       FN(corner3_2_)(x->upper ^ hash, c, FN(less_one_)(x->f), y));
}
SL_INLINE FN(three_) FN(sum3_2_)(const FN(axis3_) * x, const FN(axis3_) * y, uint32_t c) {
    return FN(blend3_)(y->w, FN(row3_2_)(x, y->lower, y->f, c),
                       FN(row3_2_)(x, y->upper, FN(less_one_)(y->f), c));
}

SL_INLINE FN(three_)
    FN(row3_3_)(const FN(axis3_) * x, I hash, FN(three_) y, FN(three_) z, uint32_t c) {
    return FN(blend3_)(x->w, FN(corner3_3_)(x->lower ^ hash, c, x->f, y, z),
                       FN(corner3_3_)(x->upper ^ hash, c, FN(less_one_)(x->f), y, z));
}
SL_INLINE FN(three_)
    FN(face3_3_)(const FN(axis3_) * x, const FN(axis3_) * y, I hash, FN(three_) z, uint32_t c) {
    return FN(blend3_)(y->w, FN(row3_3_)(x, y->lower ^ hash, y->f, z, c),
                       FN(row3_3_)(x, y->upper ^ hash, FN(less_one_)(y->f), z, c));
}
SL_INLINE FN(three_)
    FN(sum3_3_)(const FN(axis3_) * x, const FN(axis3_) * y, const FN(axis3_) * z, uint32_t c) {
    return FN(blend3_)(z->w, FN(face3_3_)(x, y, z->lower, z->f, c),
                       FN(face3_3_)(x, y, z->upper, FN(less_one_)(z->f), c));
}

SL_INLINE FN(three_) FN(row3_4_)(const FN(axis3_) * x, I hash, FN(three_) y, FN(three_) z,
                                 FN(three_) t, uint32_t c) {
    return FN(blend3_)(x->w, FN(corner3_4_)(x->lower ^ hash, c, x->f, y, z, t),
                       FN(corner3_4_)(x->upper ^ hash, c, FN(less_one_)(x->f), y, z, t));
}
SL_INLINE FN(three_) FN(face3_4_)(const FN(axis3_) * x, const FN(axis3_) * y, I hash, FN(three_) z,
                                  FN(three_) t, uint32_t c) {
    return FN(blend3_)(y->w, FN(row3_4_)(x, y->lower ^ hash, y->f, z, t, c),
                       FN(row3_4_)(x, y->upper ^ hash, FN(less_one_)(y->f), z, t, c));
}
SL_INLINE FN(three_) FN(cube3_4_)(const FN(axis3_) * x, const FN(axis3_) * y, const FN(axis3_) * z,
                                  I hash, FN(three_) t, uint32_t c) {
    return FN(blend3_)(z->w, FN(face3_4_)(x, y, z->lower ^ hash, z->f, t, c),
                       FN(face3_4_)(x, y, z->upper ^ hash, FN(less_one_)(z->f), t, c));
}
SL_INLINE FN(three_) FN(sum3_4_)(const FN(axis3_) * x, const FN(axis3_) * y, const FN(axis3_) * z,
                                 const FN(axis3_) * t, uint32_t c) {
    return FN(blend3_)(t->w, FN(cube3_4_)(x, y, z, t->lower, t->f, c),
                       FN(cube3_4_)(x, y, z, t->upper, FN(less_one_)(t->f), c));
}

/* --- points and steps
 * ---------------------------------------------------------------------------------------------
 */

/* Coordinates of a point of up to 4 dimensions, with their periods. */
typedef struct FN(place4_) {
    F a[4], period[4];
} FN(place4_);

SL_INLINE F FN(rounded_period_)(F period) {
    return FN(lesser_f)(FN(greater_f)(FN(floor)(period + 0.5f), K(1)), K(0x1p23f));
}

/* The lattice around a point, before or after a step. */
typedef struct FN(cell4_) {
    FN(axis_) axis[4];
    I index[4]; /* of the lower corner, 0 .. period-1 if periodic */
} FN(cell4_);

static const uint32_t FN(primes_)[4] = {NOISE_P0, NOISE_P1, NOISE_P2, NOISE_P3};

/* One axis whose index and offset are known. */
SL_INLINE FN(axis_) FN(axis_at_)(I index, F f, F period, int dims, int k, int periodic) {
    const uint32_t seed = k == 0 ? NOISE_SEED((uint32_t)dims) : 0;
    FN(axis_) r;
    r.lower = FN(add_i)(FN(mul_i)(index, FN(primes_)[k]), KI((int)seed));
    r.upper = FN(add_i)(r.lower, KI((int)FN(primes_)[k]));
    if (periodic) {
        const F last = FN(rounded_period_)(period) - 1.0f;
        r.upper = FN(select_i)(LE(last, FN(float_of_i)(index)), KI((int)seed), r.upper);
    }
    r.f = f;
    r.w = FN(fade_)(f);
    return r;
}

SL_INLINE void FN(cell_around_)(FN(cell4_) * r, const FN(place4_) * p, int dims, int periodic) {
    NOISE_UNROLL for (int k = 0; k < dims; k++) {
        const F whole = FN(floor)(p->a[k]);
        r->index[k] = FN(whole_of_f)(
            periodic ? FN(wrapped_)(whole, FN(rounded_period_)(p->period[k])) : whole);
        r->axis[k] = FN(axis_at_)(r->index[k], p->a[k] - whole, p->period[k], dims, k, periodic);
    }
}

/* Cells are counted in integers: at positions from 2^24 on floats cannot. */
SL_INLINE void FN(cell_after_)(FN(cell4_) * r, const FN(cell4_) * from, const FN(place4_) * p,
                               const FN(place4_) * d, int dims, int periodic) {
    NOISE_UNROLL for (int k = 0; k < dims; k++) {
        const F sum = from->axis[k].f + d->a[k], crossed = FN(floor)(sum);
        F period = p->period[k];
        if (periodic) {
            const F size0 = FN(rounded_period_)(period),
                    size = FN(rounded_period_)(period + d->period[k]);
            const F kept = FN(wrapped_)(FN(float_of_i)(from->index[k]) + crossed, size);
            const F other = FN(wrapped_)(FN(floor)(p->a[k]) + crossed, size);
            r->index[k] = FN(whole_of_f)(SEL(EQ(size, size0), kept, other));
            period = size;
        } else {
            r->index[k] = FN(add_i)(from->index[k], FN(whole_of_f)(crossed));
        }
        r->axis[k] = FN(axis_at_)(r->index[k], sum - crossed, period, dims, k, periodic);
    }
}

/* Where the step must be taken as a difference of two values. */
SL_INLINE I FN(far_step_)(const FN(cell4_) * from, const FN(place4_) * p, const FN(place4_) * d,
                          int dims, int periodic) {
    I leaves = KI(0), is_long = KI(0), is_very_long = KI(0), other = KI(0);
    NOISE_UNROLL for (int k = 0; k < dims; k++) {
        const F sum = from->axis[k].f + d->a[k];
        leaves = leaves | ~(LE(K(0), sum) & LE(sum, K(1)));
        const F size = FN(abs)(d->a[k]);
        is_long = is_long | ~LE(size, K(NEAR_STEP));
        is_very_long = is_very_long | ~LT(size, K(LONG_STEP));
        if (periodic)
            other = other | ~EQ(FN(rounded_period_)(p->period[k]),
                                FN(rounded_period_)(p->period[k] + d->period[k]));
    }
    return (leaves & is_long) | is_very_long | other;
}

/* Not inlined: most packets need it seldom. */
static __attribute__((noinline)) F FN(sum_n_)(const FN(cell4_) * at, int dims, uint32_t c) {
    const FN(axis_)* x = at->axis;
    return dims == 1   ? FN(sum_1_)(x[0], c)
           : dims == 2 ? FN(sum_2_)(x[0], x[1], c)
           : dims == 3 ? FN(sum_3_)(x[0], x[1], x[2], c)
                       : FN(sum_4_)(x[0], x[1], x[2], x[3], c);
}

SL_INLINE FN(three_) FN(sum3_n_)(const FN(axis3_) * x, int dims, uint32_t c) {
    return dims == 1   ? FN(sum3_1_)(x, c)
           : dims == 2 ? FN(sum3_2_)(x, x + 1, c)
           : dims == 3 ? FN(sum3_3_)(x, x + 1, x + 2, c)
                       : FN(sum3_4_)(x, x + 1, x + 2, x + 3, c);
}

SL_INLINE float FN(noise_scale_)(int dims) {
    return dims == 1 ? 0.094f : dims == 2 ? 0.2535f : dims == 3 ? 0.468f : 0.435f;
}

/* 1/2 + k (sum + change), limited in four dimensions, minus the same without the change. */
SL_INLINE F FN(value_change_)(F sum, F change, int dims) {
    const float k = FN(noise_scale_)(dims);
    const F at = FN(scaled_)(sum, k), d = FLOAT(BITS(change * k) & EQ(change, change));
    if (dims < 4)
        return d;
    const F zero = K(0), one = K(1), after = at + d;
    const F limited = FN(clamp_f)(after, zero, one) - FN(clamp_f)(at, zero, one);
    return SEL(EQ(limited, after - at), d, limited);
}

/* --- one and two steps
 * -------------------------------------------------------------------------------------------- */

/* Changes of `channels` sums by the step d. */
SL_INLINE void FN(noise_step_)(const FN(place4_) * p, const FN(place4_) * d, int dims, int periodic,
                               int channels, F* out) {
    static const uint32_t multipliers[3] = {NOISE_C0, NOISE_C1, NOISE_C2};
    FN(cell4_) from;
    FN(cell_around_)(&from, p, dims, periodic);
    const I far = FN(far_step_)(&from, p, d, dims, periodic);
    const int any_far = FN(any)(far), any_near = FN(any)(~far);
    FN(cell4_) to;
    if (any_far)
        FN(cell_after_)(&to, &from, p, d, dims, periodic);
    FN(axis3_) axis[4];
    NOISE_UNROLL for (int k = 0; k < dims; k++) axis[k] =
        FN(moving_axis_)(from.axis[k], d->a[k], d->a[k]);
    for (int c = 0; c < channels; c++) {
        const uint32_t m = multipliers[c];
        F at, change = K(0);
        if (any_near) {
            const FN(three_) sum = FN(sum3_n_)(axis, dims, m);
            at = sum.at, change = sum.u;
        } else {
            at = FN(sum_n_)(&from, dims, m);
        }
        if (any_far)
            change = SEL(far, FN(sum_n_)(&to, dims, m) - at, change);
        out[c] = FN(value_change_)(at, change, dims);
    }
}

/* `channels` values and their changes by the steps u and v, from one look at the lattice. */
SL_INLINE void FN(noise_steps_)(const FN(place4_) * p, const FN(place4_) * u, const FN(place4_) * v,
                                int dims, int channels, F* at, F* by_u, F* by_v) {
    static const uint32_t multipliers[3] = {NOISE_C0, NOISE_C1, NOISE_C2};
    FN(cell4_) from;
    FN(cell_around_)(&from, p, dims, 0);
    const I far_u = FN(far_step_)(&from, p, u, dims, 0),
            far_v = FN(far_step_)(&from, p, v, dims, 0);
    const int any_u = FN(any)(far_u), any_v = FN(any)(far_v), any_near = FN(any)(~(far_u & far_v));
    FN(cell4_) to_u, to_v;
    if (any_u)
        FN(cell_after_)(&to_u, &from, p, u, dims, 0);
    if (any_v)
        FN(cell_after_)(&to_v, &from, p, v, dims, 0);
    FN(axis3_) axis[4];
    NOISE_UNROLL for (int k = 0; k < dims; k++) axis[k] =
        FN(moving_axis_)(from.axis[k], u->a[k], v->a[k]);
    for (int c = 0; c < channels; c++) {
        const uint32_t m = multipliers[c];
        FN(three_) sum;
        if (any_near)
            sum = FN(sum3_n_)(axis, dims, m);
        else
            sum = FN(three_of_)(FN(sum_n_)(&from, dims, m), K(0), K(0));
        if (any_u)
            sum.u = SEL(far_u, FN(sum_n_)(&to_u, dims, m) - sum.at, sum.u);
        if (any_v)
            sum.v = SEL(far_v, FN(sum_n_)(&to_v, dims, m) - sum.at, sum.v);
        const F value = FN(scaled_)(sum.at, FN(noise_scale_)(dims));
        at[c] = dims < 4 ? value : FN(clamp_f)(value, K(0), K(1));
        by_u[c] = FN(value_change_)(sum.at, sum.u, dims);
        by_v[c] = FN(value_change_)(sum.at, sum.v, dims);
    }
}

SL_INLINE FN(place4_) FN(place_1_)(F x) {
    FN(place4_) p = {0}; /* axes beyond the dimensions are copied too */
    p.a[0] = x;
    return p;
}
SL_INLINE FN(place4_) FN(place_2_)(F x, F y) {
    FN(place4_) p = {0}; /* axes beyond the dimensions are copied too */
    p.a[0] = x, p.a[1] = y;
    return p;
}
SL_INLINE FN(place4_) FN(place_3_)(V a) {
    FN(place4_) p = {0}; /* axes beyond the dimensions are copied too */
    p.a[0] = a.x, p.a[1] = a.y, p.a[2] = a.z;
    return p;
}
SL_INLINE FN(place4_) FN(place_4_)(V a, F t) {
    FN(place4_) p = {0}; /* axes beyond the dimensions are copied too */
    p.a[0] = a.x, p.a[1] = a.y, p.a[2] = a.z, p.a[3] = t;
    return p;
}
SL_INLINE FN(place4_) FN(with_period_)(FN(place4_) p, FN(place4_) period) {
    for (int k = 0; k < 4; k++)
        p.period[k] = period.a[k];
    return p;
}

SL_INLINE F FN(one_change_)(FN(place4_) p, FN(place4_) d, int dims, int periodic) {
    F out[1];
    FN(noise_step_)(&p, &d, dims, periodic, 1, out);
    return out[0];
}
SL_INLINE V FN(three_changes_)(FN(place4_) p, FN(place4_) d, int dims, int periodic) {
    F out[3];
    FN(noise_step_)(&p, &d, dims, periodic, 3, out);
    return FN(make_3)(out[0], out[1], out[2]);
}

F FN(noise_f_1_d)(F x, F dx) {
    return FN(one_change_)(FN(place_1_)(x), FN(place_1_)(dx), 1, 0);
}
F FN(noise_f_2_d)(F x, F y, F dx, F dy) {
    return FN(one_change_)(FN(place_2_)(x, y), FN(place_2_)(dx, dy), 2, 0);
}
F FN(noise_f_3_d)(V p, V dp) {
    return FN(one_change_)(FN(place_3_)(p), FN(place_3_)(dp), 3, 0);
}
F FN(noise_f_4_d)(V p, F t, V dp, F dt) {
    return FN(one_change_)(FN(place_4_)(p, t), FN(place_4_)(dp, dt), 4, 0);
}
V FN(noise_3_1_d)(F x, F dx) {
    return FN(three_changes_)(FN(place_1_)(x), FN(place_1_)(dx), 1, 0);
}
V FN(noise_3_2_d)(F x, F y, F dx, F dy) {
    return FN(three_changes_)(FN(place_2_)(x, y), FN(place_2_)(dx, dy), 2, 0);
}
V FN(noise_3_3_d)(V p, V dp) {
    return FN(three_changes_)(FN(place_3_)(p), FN(place_3_)(dp), 3, 0);
}
V FN(noise_3_4_d)(V p, F t, V dp, F dt) {
    return FN(three_changes_)(FN(place_4_)(p, t), FN(place_4_)(dp, dt), 4, 0);
}

/* Periodic: places and steps of the point, each with that of the period. */
#define PERIODIC(a, period) FN(with_period_)(a, period)

F FN(pnoise_f_1_d)(F x, F px, F dx, F dpx) {
    return FN(one_change_)(PERIODIC(FN(place_1_)(x), FN(place_1_)(px)),
                           PERIODIC(FN(place_1_)(dx), FN(place_1_)(dpx)), 1, 1);
}
F FN(pnoise_f_2_d)(F x, F y, F px, F py, F dx, F dy, F dpx, F dpy) {
    return FN(one_change_)(PERIODIC(FN(place_2_)(x, y), FN(place_2_)(px, py)),
                           PERIODIC(FN(place_2_)(dx, dy), FN(place_2_)(dpx, dpy)), 2, 1);
}
F FN(pnoise_f_3_d)(V p, V pp, V dp, V dpp) {
    return FN(one_change_)(PERIODIC(FN(place_3_)(p), FN(place_3_)(pp)),
                           PERIODIC(FN(place_3_)(dp), FN(place_3_)(dpp)), 3, 1);
}
F FN(pnoise_f_4_d)(V p, F t, V pp, F pt, V dp, F dt, V dpp, F dpt) {
    return FN(one_change_)(PERIODIC(FN(place_4_)(p, t), FN(place_4_)(pp, pt)),
                           PERIODIC(FN(place_4_)(dp, dt), FN(place_4_)(dpp, dpt)), 4, 1);
}
V FN(pnoise_3_1_d)(F x, F px, F dx, F dpx) {
    return FN(three_changes_)(PERIODIC(FN(place_1_)(x), FN(place_1_)(px)),
                              PERIODIC(FN(place_1_)(dx), FN(place_1_)(dpx)), 1, 1);
}
V FN(pnoise_3_2_d)(F x, F y, F px, F py, F dx, F dy, F dpx, F dpy) {
    return FN(three_changes_)(PERIODIC(FN(place_2_)(x, y), FN(place_2_)(px, py)),
                              PERIODIC(FN(place_2_)(dx, dy), FN(place_2_)(dpx, dpy)), 2, 1);
}
V FN(pnoise_3_3_d)(V p, V pp, V dp, V dpp) {
    return FN(three_changes_)(PERIODIC(FN(place_3_)(p), FN(place_3_)(pp)),
                              PERIODIC(FN(place_3_)(dp), FN(place_3_)(dpp)), 3, 1);
}
V FN(pnoise_3_4_d)(V p, F t, V pp, F pt, V dp, F dt, V dpp, F dpt) {
    return FN(three_changes_)(PERIODIC(FN(place_4_)(p, t), FN(place_4_)(pp, pt)),
                              PERIODIC(FN(place_4_)(dp, dt), FN(place_4_)(dpp, dpt)), 4, 1);
}
#undef PERIODIC

/* --- value and both changes at once; emitted code does not call these yet
 * ---------------------------- */

SL_INLINE F FN(one_uv_)(FN(place4_) p, FN(place4_) u, FN(place4_) v, int dims, F* by_u, F* by_v) {
    F at[1];
    FN(noise_steps_)(&p, &u, &v, dims, 1, at, by_u, by_v);
    return at[0];
}
SL_INLINE V FN(three_uv_)(FN(place4_) p, FN(place4_) u, FN(place4_) v, int dims, V* by_u, V* by_v) {
    F at[3], cu[3], cv[3];
    FN(noise_steps_)(&p, &u, &v, dims, 3, at, cu, cv);
    *by_u = FN(make_3)(cu[0], cu[1], cu[2]);
    *by_v = FN(make_3)(cv[0], cv[1], cv[2]);
    return FN(make_3)(at[0], at[1], at[2]);
}

F FN(noise_f_1_uv)(F x, F xu, F xv, F* by_u, F* by_v) {
    return FN(one_uv_)(FN(place_1_)(x), FN(place_1_)(xu), FN(place_1_)(xv), 1, by_u, by_v);
}
F FN(noise_f_2_uv)(F x, F y, F xu, F yu, F xv, F yv, F* by_u, F* by_v) {
    return FN(one_uv_)(FN(place_2_)(x, y), FN(place_2_)(xu, yu), FN(place_2_)(xv, yv), 2, by_u,
                       by_v);
}
F FN(noise_f_3_uv)(V p, V u, V v, F* by_u, F* by_v) {
    return FN(one_uv_)(FN(place_3_)(p), FN(place_3_)(u), FN(place_3_)(v), 3, by_u, by_v);
}
F FN(noise_f_4_uv)(V p, F t, V u, F tu, V v, F tv, F* by_u, F* by_v) {
    return FN(one_uv_)(FN(place_4_)(p, t), FN(place_4_)(u, tu), FN(place_4_)(v, tv), 4, by_u, by_v);
}
V FN(noise_3_1_uv)(F x, F xu, F xv, V* by_u, V* by_v) {
    return FN(three_uv_)(FN(place_1_)(x), FN(place_1_)(xu), FN(place_1_)(xv), 1, by_u, by_v);
}
V FN(noise_3_2_uv)(F x, F y, F xu, F yu, F xv, F yv, V* by_u, V* by_v) {
    return FN(three_uv_)(FN(place_2_)(x, y), FN(place_2_)(xu, yu), FN(place_2_)(xv, yv), 2, by_u,
                         by_v);
}
V FN(noise_3_3_uv)(V p, V u, V v, V* by_u, V* by_v) {
    return FN(three_uv_)(FN(place_3_)(p), FN(place_3_)(u), FN(place_3_)(v), 3, by_u, by_v);
}
V FN(noise_3_4_uv)(V p, F t, V u, F tu, V v, F tv, V* by_u, V* by_v) {
    return FN(three_uv_)(FN(place_4_)(p, t), FN(place_4_)(u, tu), FN(place_4_)(v, tv), 4, by_u,
                         by_v);
}

/* --- cells: 0, or the jump into the cell that a + d lies in
 * ------------------------------------------------------- */

SL_INLINE I FN(cell_moved_)(F a, F d) {
    return FN(add_i)(FN(cell_index_)(a), FN(whole_of_f)(FN(floor_d)(a, d)));
}

/* Hashes of the cells of a point and of the point moved. */
SL_INLINE I FN(cell_hash_)(const FN(place4_) * p, const FN(place4_) * d, int dims, int moves) {
    I h = KI(0);
    NOISE_UNROLL for (int k = 0; k < dims; k++) {
        const I index = moves ? FN(cell_moved_)(p->a[k], d->a[k]) : FN(cell_index_)(p->a[k]);
        const I term = FN(mul_i)(index, FN(primes_)[k]);
        h = k == 0 ? FN(add_i)(term, KI((int)(CELL_SEED * (uint32_t)dims))) : h ^ term;
    }
    return h;
}

SL_INLINE F FN(cell_change_)(FN(place4_) p, FN(place4_) d, int dims) {
    const I before = FN(cell_hash_)(&p, &d, dims, 0), after = FN(cell_hash_)(&p, &d, dims, 1);
    return FN(cell_value_)(after, K(0)) - FN(cell_value_)(before, K(0));
}
SL_INLINE V FN(cell_changes_)(FN(place4_) p, FN(place4_) d, int dims) {
    const I before = FN(cell_hash_)(&p, &d, dims, 0), after = FN(cell_hash_)(&p, &d, dims, 1);
    return FN(sub_3)(FN(cell_channels_)(after, K(0)), FN(cell_channels_)(before, K(0)));
}

F FN(cellnoise_f_1_d)(F x, F dx) {
    return FN(cell_change_)(FN(place_1_)(x), FN(place_1_)(dx), 1);
}
F FN(cellnoise_f_2_d)(F x, F y, F dx, F dy) {
    return FN(cell_change_)(FN(place_2_)(x, y), FN(place_2_)(dx, dy), 2);
}
F FN(cellnoise_f_3_d)(V p, V dp) {
    return FN(cell_change_)(FN(place_3_)(p), FN(place_3_)(dp), 3);
}
F FN(cellnoise_f_4_d)(V p, F t, V dp, F dt) {
    return FN(cell_change_)(FN(place_4_)(p, t), FN(place_4_)(dp, dt), 4);
}
V FN(cellnoise_3_1_d)(F x, F dx) {
    return FN(cell_changes_)(FN(place_1_)(x), FN(place_1_)(dx), 1);
}
V FN(cellnoise_3_2_d)(F x, F y, F dx, F dy) {
    return FN(cell_changes_)(FN(place_2_)(x, y), FN(place_2_)(dx, dy), 2);
}
V FN(cellnoise_3_3_d)(V p, V dp) {
    return FN(cell_changes_)(FN(place_3_)(p), FN(place_3_)(dp), 3);
}
V FN(cellnoise_3_4_d)(V p, F t, V dp, F dt) {
    return FN(cell_changes_)(FN(place_4_)(p, t), FN(place_4_)(dp, dt), 4);
}
