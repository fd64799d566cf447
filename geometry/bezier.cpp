// SPDX-License-Identifier: Apache-2.0
#include "geometry/bezier.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace geo {

namespace {

// Bezier points from the geometry vector of another cubic basis: M_bez^-1 M (ri.md 11.4).
std::vector<double> bezier_from_basis(const std::array<float, 16>& basis) {
    constexpr double inverse_bezier[4][4] = {
        {0, 0, 0, 1}, {0, 0, 1.0 / 3, 1}, {0, 1.0 / 3, 2.0 / 3, 1}, {1, 1, 1, 1}};
    std::vector<double> m(16, 0.0);
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
            for (std::size_t k = 0; k < 4; ++k) {
                m[i * 4 + j] += inverse_bezier[i][k] * static_cast<double>(basis[k * 4 + j]);
            }
        }
    }
    return m;
}

// RIB writes bases in decimal (0.166667), so the end of one patch and the beginning of the next, a
// step further, are the same combination of control points but for the last digits. Where they are,
// they are made so exactly, for meshes and for separate Patch requests alike.
void join_ends(std::vector<double>& weights, std::size_t step) {
    constexpr double same = 5e-5;
    const auto largest = [&](double most, double w) { return std::max(most, std::fabs(w)); };
    const double limit = same * std::accumulate(weights.begin(), weights.end(), 0.0, largest);
    double *first = weights.data(), *last = weights.data() + 12;
    std::array<double, 4> joined{};
    for (std::size_t j = 0; j < 4; ++j) {
        joined[j] = j < step ? 0 : first[j - step];
        const bool beyond = j + step >= 4;
        if (std::fabs(last[j] - joined[j]) > limit || (beyond && std::fabs(first[j]) > limit)) {
            return;
        }
    }
    std::copy(joined.begin(), joined.end(), last);
    std::fill(first + (4 - std::min<std::size_t>(step, 4)), first + 4, 0.0);
}

// Blossom of the B-spline piece over knot span k: row of weights on control points k-p .. k for the
// arguments.
std::vector<double> blossom(int p, int k, std::span<const float> knots,
                            std::span<const double> arguments) {
    const auto n = static_cast<std::size_t>(p) + 1;
    // d[i] holds, as a row over the inputs, the i-th intermediate point of de Boor's triangle.
    std::vector<std::vector<double>> d(n, std::vector<double>(n, 0.0));
    for (std::size_t i = 0; i < n; ++i) {
        d[i][i] = 1;
    }
    for (int r = 1; r <= p; ++r) {
        const double x = arguments[static_cast<std::size_t>(r - 1)];
        for (int i = p; i >= r; --i) {
            const auto knot = [&](int at) {
                return static_cast<double>(knots[static_cast<std::size_t>(at)]);
            };
            const double lo = knot(k - p + i), hi = knot(k + i - r + 1);
            const double alpha = hi > lo ? (x - lo) / (hi - lo) : 0;
            auto& row = d[static_cast<std::size_t>(i)];
            const auto& below = d[static_cast<std::size_t>(i - 1)];
            for (std::size_t c = 0; c < n; ++c) {
                row[c] = (1 - alpha) * below[c] + alpha * row[c];
            }
        }
    }
    return d.back();
}

// Per component, the largest magnitude of all values: what "the same but for rounding" is measured
// against.
std::vector<double> magnitudes(const std::vector<double>& values, int dim) {
    std::vector<double> largest(static_cast<std::size_t>(dim), 0.0);
    for (std::size_t i = 0; i < values.size(); ++i) {
        double& m = largest[i % largest.size()];
        m = std::max(m, std::fabs(values[i]));
    }
    return largest;
}

// Coordinates are floats: points that ought to coincide (NURBS spans, power coefficients) differ by
// a few 1e-7 of the extent.
constexpr double weld_tolerance = 5e-7;

bool nearly_equal(const double* a, const double* b, const std::vector<double>& magnitude) {
    for (std::size_t k = 0; k < magnitude.size(); ++k) {
        if (!(std::fabs(a[k] - b[k]) <= weld_tolerance * magnitude[k])) {
            return false;
        }
    }
    return true;
}

} // namespace

std::optional<SpanMap> SpanMap::bicubic(int num_points, bool periodic,
                                        const std::array<float, 16>& basis, int step,
                                        std::string& reason) {
    if (step < 1) {
        reason = "the basis step must be at least 1";
        return std::nullopt;
    }
    if (num_points < (periodic ? 3 : 4)) {
        reason = "a bicubic direction needs at least 4 control points (3 when periodic), got " +
                 std::to_string(num_points);
        return std::nullopt;
    }
    SpanMap map;
    map.degree_ = 3;
    map.num_points_ = num_points;
    map.periodic_ = periodic;
    map.num_segments_ = periodic ? num_points / step : (num_points - 4) / step + 1;
    if (map.num_segments_ < 1) {
        reason = "the basis step is larger than the number of control points";
        return std::nullopt;
    }
    std::vector<double> weights = bezier_from_basis(basis);
    join_ends(weights, static_cast<std::size_t>(step));
    for (int a = 0; a < map.num_segments_; ++a) {
        Part part;
        for (int i = 0; i < 4; ++i) {
            part.input.push_back((a * step + i) % num_points);
        }
        part.weights = weights;
        part.t0 = static_cast<double>(a) / map.num_segments_;
        part.t1 = static_cast<double>(a + 1) / map.num_segments_;
        part.segment = a;
        part.s0 = part.t0;
        part.s1 = part.t1;
        map.parts_.push_back(std::move(part));
    }
    return map;
}

std::optional<SpanMap> SpanMap::bilinear(int num_points, bool periodic, std::string& reason) {
    if (num_points < 2) {
        reason = "a bilinear direction needs at least 2 control points";
        return std::nullopt;
    }
    SpanMap map;
    map.degree_ = 1;
    map.num_points_ = num_points;
    map.periodic_ = periodic;
    map.num_segments_ = periodic ? num_points : num_points - 1;
    for (int a = 0; a < map.num_segments_; ++a) {
        const double t0 = static_cast<double>(a) / map.num_segments_;
        const double t1 = static_cast<double>(a + 1) / map.num_segments_;
        map.parts_.push_back({{a, (a + 1) % num_points}, {1, 0, 0, 1}, t0, t1, a, t0, t1});
    }
    return map;
}

std::optional<SpanMap> SpanMap::nurbs(int num_points, int order, std::span<const float> knots,
                                      double min, double max, std::string& reason) {
    if (order < 2 || order - 1 > max_degree) {
        reason = "the order must lie between 2 and " + std::to_string(max_degree + 1);
        return std::nullopt;
    }
    if (num_points < order) {
        reason = "fewer control points than the order";
        return std::nullopt;
    }
    if (knots.size() < static_cast<std::size_t>(num_points + order)) {
        reason = "needs " + std::to_string(num_points + order) + " knots";
        return std::nullopt;
    }
    if (!std::is_sorted(knots.begin(), knots.end())) {
        reason = "the knots decrease";
        return std::nullopt;
    }
    const int p = order - 1;
    SpanMap map;
    map.degree_ = p;
    map.num_points_ = num_points;
    map.num_segments_ = 1 + num_points - order;
    min = std::max(min, static_cast<double>(knots[static_cast<std::size_t>(p)]));
    max = std::min(max, static_cast<double>(knots[static_cast<std::size_t>(num_points)]));
    for (int k = p; k < num_points; ++k) {
        const double a = std::max(min, static_cast<double>(knots[static_cast<std::size_t>(k)]));
        const double b = std::min(max, static_cast<double>(knots[static_cast<std::size_t>(k) + 1]));
        if (!(a < b)) {
            continue;
        }
        Part part;
        part.t0 = a;
        part.t1 = b;
        part.segment = k - p;
        part.s0 = static_cast<double>(knots[static_cast<std::size_t>(k)]);
        part.s1 = static_cast<double>(knots[static_cast<std::size_t>(k) + 1]);
        for (int i = 0; i <= p; ++i) {
            part.input.push_back(k - p + i);
        }
        for (int j = 0; j <= p; ++j) {
            std::vector<double> arguments(static_cast<std::size_t>(p), a);
            std::fill(arguments.end() - j, arguments.end(), b);
            const std::vector<double> row = blossom(p, k, knots, arguments);
            part.weights.insert(part.weights.end(), row.begin(), row.end());
        }
        map.parts_.push_back(std::move(part));
    }
    if (map.parts_.empty()) {
        reason = "the parameter range holds no knot span";
        return std::nullopt;
    }
    return map;
}

// De Casteljau at 1/2: row i of the left half is the mean over level i, the right half mirrors it.
SpanMap SpanMap::halved() const {
    SpanMap map = *this;
    map.parts_.clear();
    const auto n = static_cast<std::size_t>(degree_) + 1;
    for (const Part& whole : parts_) {
        const std::size_t columns = whole.input.size();
        Part left = whole, right = whole;
        left.t1 = right.t0 = (whole.t0 + whole.t1) / 2;
        std::vector<double> level = whole.weights;
        for (std::size_t r = 0; r < n; ++r) {
            std::copy_n(level.begin(), columns,
                        left.weights.begin() + static_cast<std::ptrdiff_t>(r * columns));
            std::copy_n(level.begin() + static_cast<std::ptrdiff_t>((n - 1 - r) * columns), columns,
                        right.weights.begin() + static_cast<std::ptrdiff_t>((n - 1 - r) * columns));
            for (std::size_t i = 0; i < (n - 1 - r) * columns; ++i) {
                level[i] = (level[i] + level[i + columns]) / 2;
            }
        }
        map.parts_.push_back(std::move(left));
        map.parts_.push_back(std::move(right));
    }
    return map;
}

std::optional<PatchLayout> PatchLayout::make(const rib::Patches& patches, const rib::Basis& basis,
                                             std::string& reason) {
    auto u = patches.bicubic
                 ? SpanMap::bicubic(patches.nu, patches.uperiodic, basis.u, basis.ustep, reason)
                 : SpanMap::bilinear(patches.nu, patches.uperiodic, reason);
    auto v = patches.bicubic
                 ? SpanMap::bicubic(patches.nv, patches.vperiodic, basis.v, basis.vstep, reason)
                 : SpanMap::bilinear(patches.nv, patches.vperiodic, reason);
    if (!u || !v) {
        return std::nullopt;
    }
    return PatchLayout{std::move(*u), std::move(*v)};
}

std::optional<PatchLayout> PatchLayout::make(const rib::NuPatch& patch, std::string& reason) {
    auto u = SpanMap::nurbs(patch.nu, patch.uorder, patch.uknot, static_cast<double>(patch.umin),
                            static_cast<double>(patch.umax), reason);
    auto v = SpanMap::nurbs(patch.nv, patch.vorder, patch.vknot, static_cast<double>(patch.vmin),
                            static_cast<double>(patch.vmax), reason);
    if (!u || !v) {
        return std::nullopt;
    }
    return PatchLayout{std::move(*u), std::move(*v)};
}

std::size_t PatchLayout::heap_bytes() const {
    std::size_t sum = 0;
    for (const SpanMap* map : {&u, &v}) {
        sum += map->parts().capacity() * sizeof(SpanMap::Part);
        for (const SpanMap::Part& p : map->parts()) {
            sum += p.input.capacity() * sizeof(int) + p.weights.capacity() * sizeof(double);
        }
    }
    return sum;
}

namespace {

// Rounding differs between the two parts that share an edge; the later one takes over the earlier
// one's values where they agree but for rounding. Discontinuous bases (steps that do not join) stay
// apart.
void weld_edges(const PatchLayout& layout, std::vector<double>& values, int dim) {
    const auto nu = static_cast<int>(layout.u.parts().size());
    const auto nv = static_cast<int>(layout.v.parts().size());
    const int du = layout.u.degree(), dv = layout.v.degree();
    const auto at = [&](int a, int b, int i, int j) {
        const auto part = static_cast<std::size_t>(b * nu + a);
        const auto point = static_cast<std::size_t>(j * (du + 1) + i);
        return values.data() +
               (part * layout.points_per_part() + point) * static_cast<std::size_t>(dim);
    };
    const std::vector<double> magnitude = magnitudes(values, dim);
    const auto weld = [&](const double* from, double* to) {
        if (from != to && nearly_equal(from, to, magnitude)) {
            std::copy_n(from, dim, to);
        }
    };
    for (int b = 0; b < nv; ++b) {
        for (int a = 0; a < nu; ++a) {
            const bool has_right = a + 1 < nu, has_upper = b + 1 < nv;
            for (int j = 0; j <= dv && (has_right || layout.u.periodic()); ++j) {
                has_right ? weld(at(a, b, du, j), at(a + 1, b, 0, j))
                          : weld(at(0, b, 0, j), at(a, b, du, j));
            }
            for (int i = 0; i <= du && (has_upper || layout.v.periodic()); ++i) {
                has_upper ? weld(at(a, b, i, dv), at(a, b + 1, i, 0))
                          : weld(at(a, 0, i, 0), at(a, b, i, dv));
            }
        }
    }
}

} // namespace

std::vector<double> bezier_values(const PatchLayout& layout, std::span<const double> control,
                                  int dim) {
    const auto nu = layout.u.parts().size(), nv = layout.v.parts().size();
    const auto du = static_cast<std::size_t>(layout.u.degree()) + 1;
    const auto dv = static_cast<std::size_t>(layout.v.degree()) + 1;
    const auto d = static_cast<std::size_t>(dim);
    const auto row_length = static_cast<std::size_t>(layout.u.num_points());
    std::vector<double> values(nu * nv * du * dv * d, 0.0);
    std::vector<double> columns; // control rows already mapped along u: [input v][du][dim]
    for (std::size_t b = 0; b < nv; ++b) {
        const SpanMap::Part& pv = layout.v.parts()[b];
        for (std::size_t a = 0; a < nu; ++a) {
            const SpanMap::Part& pu = layout.u.parts()[a];
            columns.assign(pv.input.size() * du * d, 0.0);
            for (std::size_t r = 0; r < pv.input.size(); ++r) {
                for (std::size_t i = 0; i < du; ++i) {
                    for (std::size_t c = 0; c < pu.input.size(); ++c) {
                        const double w = pu.weights[i * pu.input.size() + c];
                        const auto at = static_cast<std::size_t>(pv.input[r]) * row_length +
                                        static_cast<std::size_t>(pu.input[c]);
                        for (std::size_t k = 0; k < d && w != 0; ++k) {
                            columns[(r * du + i) * d + k] += w * control[at * d + k];
                        }
                    }
                }
            }
            double* out = values.data() + (b * nu + a) * du * dv * d;
            for (std::size_t j = 0; j < dv; ++j) {
                for (std::size_t r = 0; r < pv.input.size(); ++r) {
                    const double w = pv.weights[j * pv.input.size() + r];
                    for (std::size_t k = 0; k < du * d && w != 0; ++k) {
                        out[j * du * d + k] += w * columns[r * du * d + k];
                    }
                }
            }
        }
    }
    weld_edges(layout, values, dim);
    return values;
}

std::vector<double> position_net(const PatchLayout& layout, std::span<const double> control,
                                 bool rational) {
    if (rational) {
        return bezier_values(layout, control, 4);
    }
    const std::vector<double> plain = bezier_values(layout, control, 3);
    std::vector<double> net;
    net.reserve(plain.size() / 3 * 4);
    for (std::size_t i = 0; i < plain.size(); i += 3) {
        net.insert(net.end(), {plain[i], plain[i + 1], plain[i + 2], 1});
    }
    return net;
}

void bernstein(int degree, double t, double* value, double* derivative) {
    const double s = 1 - t;
    // Polynomials of degree-1 first: their differences are the derivatives.
    value[0] = 1;
    for (int d = 1; d < degree; ++d) {
        value[d] = t * value[d - 1];
        for (int i = d - 1; i > 0; --i) {
            value[i] = s * value[i] + t * value[i - 1];
        }
        value[0] *= s;
    }
    if (degree == 0) {
        derivative[0] = 0;
        return;
    }
    derivative[0] = -degree * value[0];
    derivative[degree] = degree * value[degree - 1];
    for (int i = 1; i < degree; ++i) {
        derivative[i] = degree * (value[i - 1] - value[i]);
    }
    value[degree] = t * value[degree - 1];
    for (int i = degree - 1; i > 0; --i) {
        value[i] = s * value[i] + t * value[i - 1];
    }
    value[0] *= s;
}

BezierPoint evaluate_part(int degree_u, int degree_v, const double* net, double s, double t) {
    double bu[max_degree + 1], du[max_degree + 1], bv[max_degree + 1], dv[max_degree + 1];
    bernstein(degree_u, s, bu, du);
    bernstein(degree_v, t, bv, dv);
    double p[4] = {}, pu[4] = {}, pv[4] = {};
    for (int j = 0; j <= degree_v; ++j) {
        double row[4] = {}, row_du[4] = {};
        for (int i = 0; i <= degree_u; ++i, net += 4) {
            for (int k = 0; k < 4; ++k) {
                row[k] += bu[i] * net[k];
                row_du[k] += du[i] * net[k];
            }
        }
        for (int k = 0; k < 4; ++k) {
            p[k] += bv[j] * row[k];
            pu[k] += bv[j] * row_du[k];
            pv[k] += dv[j] * row[k];
        }
    }
    // Quotient rule: (A/w)' = (A' - (A/w) w') / w.
    const double w = p[3] != 0 ? p[3] : 1;
    BezierPoint r;
    r.P = base::V3d{p[0], p[1], p[2]} / w;
    r.dPdu = (base::V3d{pu[0], pu[1], pu[2]} - r.P * pu[3]) / w;
    r.dPdv = (base::V3d{pv[0], pv[1], pv[2]} - r.P * pv[3]) / w;
    return r;
}

void evaluate_values(int degree_u, int degree_v, const double* net, int dim, double s, double t,
                     double* out) {
    double bu[max_degree + 1], bv[max_degree + 1], unused[max_degree + 1];
    bernstein(degree_u, s, bu, unused);
    bernstein(degree_v, t, bv, unused);
    std::fill_n(out, dim, 0.0);
    for (int j = 0; j <= degree_v; ++j) {
        for (int i = 0; i <= degree_u; ++i, net += dim) {
            for (int k = 0; k < dim; ++k) {
                out[k] += bu[i] * bv[j] * net[k];
            }
        }
    }
}

} // namespace geo
