/* SPDX-License-Identifier: Apache-2.0
 * Differences of spline by its value, one text per world; included by spline.c after
 * spline_body.h. (A spline is linear in its knots: what they change is spline(x + dx) of their
 * differences.) What holds for all: sl_diff_inline.h.
 */

/* Segment and place in it of a value and of the value moved. */
typedef struct FN(travel_) {
    F first, t;   /* segment, 0 <= t <= 1 */
    F first1, t1; /* after the step */
    F d;          /* length of the step in segments */
} FN(travel_);

static FN(travel_) FN(find_travel_)(const basis* b, F x, F dx, int n) {
    const float count = (float)FN(segments_)(b, n);
    const F from = FN(unit_)(x), to = FN(unit_)(FN(moved_)(x, dx));
    const F last = K(count - 1);
    FN(travel_) r;
    r.first = FN(lesser_f)(FN(floor)(from * count), last);
    r.t = from * count - r.first;
    const I low = LT(x, K(0)) | LT(x + dx, K(0));
    const F over = SEL(low, x + dx, (x - 1.0f) + dx);
    const I inside = EQ(x, from) & LE(K(0), x + dx) & LE((x - 1.0f) + dx, K(0));
    const I enters = ~EQ(x, from) & EQ(x + dx, to);
    r.d = SEL(inside, dx, SEL(enters & ~low, over, to - from)) * count;
    const F place = r.t + r.d;
    r.first1 = FN(clamp_f)(r.first + FN(floor)(place), K(0), last);
    r.t1 = place - (r.first1 - r.first);
    return r;
}

/* The change of the weight of knot k from t to t + d. */
SL_INLINE F FN(weight_change_)(const basis* b, int k, F t, F d) {
    const F u = t + d;
    return d * (b->m[k] * (t * t + t * u + u * u) + b->m[4 + k] * (t + u) + b->m[8 + k]);
}

/* Weights that give the change of the curve, for knots of the segments before and after. A step
 * into the next segment is two steps, which meet at the knot between: the curve has no jump there,
 * except in the power basis. */
typedef struct FN(changes_) {
    FN(place_) before, after;
    I same;
} FN(changes_);

SL_INLINE F FN(weight_at_)(const basis* b, int k, F t) {
    return ((t * b->m[k] + b->m[4 + k]) * t + b->m[8 + k]) * t + b->m[12 + k];
}

static FN(changes_) FN(find_changes_)(const basis* b, F x, F dx, int n) {
    const FN(travel_) way = FN(find_travel_)(b, x, dx, n);
    const F jump = way.first1 - way.first;
    const I up = EQ(jump, K(1)) & KI(-(b->step != 4)), down = EQ(jump, K(-1)) & KI(-(b->step != 4));
    FN(changes_) r;
    r.same = EQ(jump, K(0));
    r.before.first = FN(mul_i)(FN(int_of_f)(way.first), (uint32_t)b->step);
    r.after.first = FN(mul_i)(FN(int_of_f)(way.first1), (uint32_t)b->step);
    for (int k = 0; k < 4; k++) {
        const F to_end = FN(weight_change_)(b, k, way.t, 1.0f - way.t);
        const F to_start = FN(weight_change_)(b, k, way.t, -way.t);
        const F alone = FN(weight_change_)(b, k, way.t, way.d);
        const F leaves = SEL(up, to_end, SEL(down, to_start, -FN(weight_at_)(b, k, way.t)));
        const F from_start = FN(weight_change_)(b, k, K(0), way.t1);
        const F from_end = FN(weight_change_)(b, k, K(1), way.t1 - 1.0f);
        const F enters = SEL(up, from_start, SEL(down, from_end, FN(weight_at_)(b, k, way.t1)));
        r.before.weight[k] = SEL(r.same, alone, leaves);
        r.after.weight[k] = SEL(r.same, K(0), enters);
    }
    return r;
}

static F FN(spline_change_)(const basis* b, F x, F dx, const F* knots, int n) {
    const FN(changes_) p = FN(find_changes_)(b, x, dx, n);
    F leaves = K(0), enters = K(0);
    for (int k = 0; k < 4; k++) {
        leaves = leaves + p.before.weight[k] * FN(at_f)(knots, FN(add_i)(p.before.first, KI(k)));
        enters = enters + p.after.weight[k] * FN(at_f)(knots, FN(add_i)(p.after.first, KI(k)));
    }
    return FN(finite_)(leaves + enters);
}

/* The step d of the inverse with spline(x + d) - spline(x) = wanted: the difference of two
 * inverses, sharpened by the rule of proportion. */
static F FN(solve_change_)(const basis* b, F value, F dvalue, const F* knots, int n) {
    const F x = FN(solve_)(b, value, knots, n);
    const F start = FN(spline_at_)(b, K(0), knots, n), end = FN(spline_at_)(b, K(1), knots, n);
    const F low = FN(min_f)(start, end), high = FN(max_f)(start, end);
    const F wanted = FN(clamp_f_d)(value, low, high, dvalue, K(0), K(0));
    const F coarse = FN(solve_)(b, FN(moved_)(value, dvalue), knots, n) - x;
    F d = SEL(LT(FN(abs)(coarse), K(1e-4f)), SEL(LT(x, K(0.5f)), K(1e-4f), K(-1e-4f)), coarse);
    for (int i = 0; i < 6; i++) {
        const F reached = FN(spline_change_)(b, x, d, knots, n);
        const I none = EQ(reached, K(0));
        d = SEL(none, d, d * (wanted / SEL(none, K(1), reached)));
    }
    const I fine = LE(FN(abs)(d - coarse), 0.01f * FN(abs)(coarse) + 1e-6f);
    return SEL(EQ(wanted, K(0)), K(0), FN(finite_)(SEL(fine, d, coarse)));
}

F FN(spline_f_d)(sl_string name, F x, const F* knots, int n, F dx) {
    int inverse;
    const basis* b = find_basis(name, &inverse);
    if (n < 4)
        return K(0);
    return inverse ? FN(solve_change_)(b, x, dx, knots, n) : FN(spline_change_)(b, x, dx, knots, n);
}

V FN(spline_3_d)(sl_string name, F x, const V* knots, int n, F dx) {
    int inverse;
    const basis* b = find_basis(name, &inverse);
    if (n < 4)
        return FN(f_to_3)(K(0));
    const FN(changes_) p = FN(find_changes_)(b, x, dx, n);
    V leaves = FN(f_to_3)(K(0)), enters = leaves;
    for (int k = 0; k < 4; k++) {
        const V from = FN(at_3)(knots, FN(add_i)(p.before.first, KI(k)));
        const V to = FN(at_3)(knots, FN(add_i)(p.after.first, KI(k)));
        leaves = FN(add_3)(leaves, FN(scale_3)(from, p.before.weight[k]));
        enters = FN(add_3)(enters, FN(scale_3)(to, p.after.weight[k]));
    }
    return FN(finite_3_)(FN(add_3)(leaves, enters));
}
