/* SPDX-License-Identifier: Apache-2.0
 * spline on lanes with knots that all lanes share, included by spline.c after spline_body.h: what
 * most shaders write. Knots are looked up where they lie instead of being spread first; the
 * arithmetic, and so every bit, is that of spline_body.h. */

static slf shared_at(const basis* b, slf value, const float* knots, int n) {
    const slv_place_ p = slv_find_place_(b, value, n);
    slf r = {0};
    for (int k = 0; k < 4; k++)
        r = r + p.weight[k] * slu_at_lanes_f(knots + k, p.first);
    return r;
}

/* As slv_solve_. */
static slf shared_solve(const basis* b, slf value, const float* knots, int n) {
    const slf zero = {0}, one = slv_spread_f(1);
    const slf start = shared_at(b, zero, knots, n), end = shared_at(b, one, knots, n);
    const slf sign = slv_select_f(slv_le_f(start, end), one, -one);
    const slf wanted = value * sign;
    slf low = zero, width = slv_spread_f(0.5f);
    for (int i = 0; i < 31; i++) {
        const slf here = shared_at(b, low + width, knots, n) * sign;
        low = slv_select_f(slv_le_f(here, wanted), low + width, low);
        width = width * 0.5f;
    }
    low = slv_select_f(slv_le_f(wanted, start * sign), zero, low);
    return slv_select_f(slv_le_f(end * sign, wanted), one, low);
}

slf slv_spline_f_shared(sl_string name, slf x, const float* knots, int n) {
    int inverse;
    const basis* b = find_basis(name, &inverse);
    if (n < 4)
        return slv_spread_f(n > 0 ? knots[0] : 0);
    return inverse ? shared_solve(b, x, knots, n) : shared_at(b, x, knots, n);
}

slv slv_spline_3_shared(sl_string name, slf x, const slu3* knots, int n) {
    int inverse;
    const basis* b = find_basis(name, &inverse);
    if (n < 4)
        return slv_spread_3(n > 0 ? knots[0] : slu_make_3(0, 0, 0));
    const slv_place_ p = slv_find_place_(b, x, n);
    slv r = slv_f_to_3(slv_spread_f(0));
    for (int k = 0; k < 4; k++)
        r = slv_add_3(r, slv_scale_3(slu_at_lanes_3(knots + k, p.first), p.weight[k]));
    return r;
}
