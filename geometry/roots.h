// SPDX-License-Identifier: Apache-2.0
// Real roots of quadratics and quartics in double, for rays against analytic surfaces.
// Roots come back in rising order; double roots may come once or twice. Non-finite coefficients
// have no roots.
#pragma once

#include <array>

namespace geo {

struct Roots {
    std::array<double, 4> t{};
    int count = 0;

    void add(double root) { t[static_cast<std::size_t>(count++)] = root; }
    [[nodiscard]] const double* begin() const { return t.data(); }
    [[nodiscard]] const double* end() const { return t.data() + count; }
};

// a t^2 + 2 b t + c = 0 (note the 2). Stable for a -> 0, where it becomes linear.
[[nodiscard]] Roots solve_quadratic(double a, double b, double c);

// c[0] + c[1] t + ... + c[4] t^4 = 0 within [t0, t1]. Isolates roots between the roots of the
// derivatives and brackets each by Newton with bisection, so that none is lost or invented;
// tangential ones count if |f| is within its rounding.
[[nodiscard]] Roots solve_quartic(const std::array<double, 5>& c, double t0, double t1);

} // namespace geo
