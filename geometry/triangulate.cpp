// SPDX-License-Identifier: Apache-2.0
#include "geometry/triangulate.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <numeric>

namespace geo {

namespace {

constexpr std::uint32_t nil = std::numeric_limits<std::uint32_t>::max();

using Id = std::uint32_t;

// Triangles as half edges: 3t, 3t+1, 3t+2 run round triangle t, counter-clockwise. All decisions
// about topology use orient() alone, which is exact; the circle test only chooses among valid
// triangulations.
class Mesh {
public:
    // Distinct points in lexicographic order.
    explicit Mesh(std::vector<Point2> points) : p_(std::move(points)), out_(p_.size(), nil) {}

    // Triangulates the convex hull; false when all points lie on a line.
    bool build() {
        const Id first = start();
        if (first == nil) {
            return false;
        }
        for (Id i = first; i < p_.size(); ++i) {
            extend(i);
        }
        improve();
        return true;
    }

    // Makes a - b an edge (or a chain of edges through points on it) and toggles whether it is a
    // border. False if another border is in the way.
    bool toggle_border(Id a, Id b) {
        while (a != b) {
            const Crossing c = leave(a, b);
            if (c.along != nil) {
                toggle(c.along);
                a = c.target;
            } else if (c.edge == nil) {
                return false;
            } else {
                const Id target = clear_way(a, b, c.edge);
                const Id edge = target == nil ? nil : find(a, target);
                if (edge == nil) {
                    return false;
                }
                toggle(edge);
                a = target;
            }
        }
        return true;
    }

    // Per triangle: inside by the number of borders between it and the outside.
    [[nodiscard]] std::vector<bool> inside() const {
        const std::size_t n = vertex_.size() / 3;
        std::vector<bool> in(n), seen(n);
        std::vector<Id> todo;
        for (Id e = 0; e < vertex_.size(); ++e) {
            if (twin_[e] == nil && !seen[e / 3]) {
                seen[e / 3] = true;
                in[e / 3] = border_[e];
                todo.push_back(e / 3);
            }
        }
        while (!todo.empty()) {
            const Id t = todo.back();
            todo.pop_back();
            for (Id e = 3 * t; e < 3 * t + 3; ++e) {
                const Id other = twin_[e] == nil ? nil : twin_[e] / 3;
                if (other != nil && !seen[other]) {
                    seen[other] = true;
                    in[other] = in[t] != border_[e];
                    todo.push_back(other);
                }
            }
        }
        return in;
    }

    [[nodiscard]] std::size_t num_triangles() const { return vertex_.size() / 3; }
    [[nodiscard]] std::array<Id, 3> triangle(std::size_t t) const {
        return {vertex_[3 * t], vertex_[3 * t + 1], vertex_[3 * t + 2]};
    }

private:
    // How the way from one point to another begins.
    struct Crossing {
        Id along = nil;  // a half edge on the way, which ends at target ...
        Id target = nil; // ... a point on it, or
        Id edge = nil;   // the half edge opposite the start that it crosses, right end to left end
    };

    std::vector<Point2> p_;
    std::vector<Id> vertex_, twin_; // by half edge: where it starts; its opposite, nil on the hull
    std::vector<bool> border_;      // by half edge
    std::vector<Id> out_;           // by point: some half edge that starts there
    std::vector<Id> hull_next_, hull_prev_, hull_edge_; // by point, while building
    std::uint64_t flips_left_ = 0;

    static Id next(Id e) { return e % 3 == 2 ? e - 2 : e + 1; }
    static Id prev(Id e) { return e % 3 == 0 ? e + 2 : e - 1; }
    [[nodiscard]] double side(Id a, Id b, Id c) const { return orient(p_[a], p_[b], p_[c]); }

    // Half edges of the new triangle: a - b is the first.
    Id add_triangle(Id a, Id b, Id c) {
        const auto e = static_cast<Id>(vertex_.size());
        vertex_.insert(vertex_.end(), {a, b, c});
        twin_.insert(twin_.end(), 3, nil);
        border_.insert(border_.end(), 3, false);
        out_[a] = e;
        out_[b] = e + 1;
        out_[c] = e + 2;
        return e;
    }

    void link(Id e, Id f) {
        twin_[e] = f;
        twin_[f] = e;
    }

    void hull_link(Id a, Id b, Id edge) {
        hull_next_[a] = b;
        hull_prev_[b] = a;
        hull_edge_[a] = edge;
    }

    // The leading points on one line and the first one off it: a fan. Returns the index to go on
    // with.
    Id start() {
        Id apex = 2;
        while (apex < p_.size() && side(0, 1, apex) == 0) {
            ++apex;
        }
        if (apex >= p_.size()) {
            return nil;
        }
        hull_next_.resize(p_.size());
        hull_prev_.resize(p_.size());
        hull_edge_.resize(p_.size());
        std::vector<Id> line(apex);
        std::iota(line.begin(), line.end(), 0);
        if (side(0, 1, apex) < 0) {
            std::reverse(line.begin(), line.end());
        }
        Id before = nil;
        for (std::size_t i = 0; i + 1 < line.size(); ++i) {
            const Id e = add_triangle(line[i], line[i + 1], apex);
            hull_link(line[i], line[i + 1], e);
            if (before != nil) {
                link(before + 1, e + 2);
            } else {
                hull_link(apex, line[0], e + 2);
            }
            before = e;
        }
        hull_link(line.back(), apex, before + 1);
        return apex + 1;
    }

    [[nodiscard]] bool visible(Id edge_start, Id from) const {
        return side(edge_start, hull_next_[edge_start], from) < 0;
    }

    // A point beyond all earlier ones is joined to the part of the hull that it sees, around the
    // last point.
    void extend(Id p) {
        Id a = p - 1, b = p - 1;
        while (hull_prev_[a] != p - 1 && visible(hull_prev_[a], p)) {
            a = hull_prev_[a];
        }
        while (hull_next_[b] != a && visible(b, p)) {
            b = hull_next_[b];
        }
        Id before = nil, first = nil;
        for (Id v = a; v != b;) {
            const Id w = hull_next_[v];
            const Id e = add_triangle(w, v, p); // w-v, v-p, p-w
            link(e, hull_edge_[v]);
            if (before == nil) {
                first = e + 1;
            } else {
                link(e + 1, before + 2);
            }
            before = e;
            v = w;
        }
        if (before != nil) {
            hull_link(a, p, first);
            hull_link(p, b, before + 2);
        }
    }

    // Lawson's flips. Rounding may make the circle test contradict itself, hence the limit.
    void improve() {
        flips_left_ = 16 * std::uint64_t(p_.size());
        std::vector<Id> todo(vertex_.size());
        std::iota(todo.begin(), todo.end(), 0);
        while (!todo.empty() && flips_left_ > 0) {
            const Id e = todo.back();
            todo.pop_back();
            if (twin_[e] != nil && can_flip(e) && in_circle(e)) {
                const Id f = twin_[e];
                flip(e);
                todo.insert(todo.end(), {e, prev(e), f, prev(f)});
            }
        }
        flips_left_ =
            64 * std::uint64_t(p_.size()) + 100'000'000; // for the borders: against hostile input
    }

    [[nodiscard]] bool can_flip(Id e) const {
        const Id f = twin_[e], a = vertex_[e], b = vertex_[f], c = vertex_[prev(e)],
                 d = vertex_[prev(f)];
        return side(a, d, c) > 0 && side(b, c, d) > 0;
    }

    [[nodiscard]] bool in_circle(Id e) const {
        const Point2 &a = p_[vertex_[e]], &b = p_[vertex_[next(e)]], &c = p_[vertex_[prev(e)]];
        const Point2& d = p_[vertex_[prev(twin_[e])]];
        const double ax = a.x - d.x, ay = a.y - d.y, bx = b.x - d.x, by = b.y - d.y, cx = c.x - d.x,
                     cy = c.y - d.y;
        const double a2 = ax * ax + ay * ay, b2 = bx * bx + by * by, c2 = cx * cx + cy * cy;
        return ax * (by * c2 - b2 * cy) - ay * (bx * c2 - b2 * cx) + a2 * (bx * cy - by * cx) > 0;
    }

    // a-b of triangles (a, b, c) and (b, a, d) becomes c-d of (a, d, c) and (b, c, d).
    void flip(Id e) {
        --flips_left_;
        const Id f = twin_[e], e1 = next(e), e2 = prev(e), f1 = next(f), f2 = prev(f);
        const Id a = vertex_[e], b = vertex_[f], c = vertex_[e2], d = vertex_[f2];
        const Id twin_ad = twin_[f1], twin_bc = twin_[e1];
        const bool border_ad = border_[f1], border_bc = border_[e1];
        vertex_[e1] = d;
        vertex_[f1] = c;
        outer(e, twin_ad, border_ad);
        outer(f, twin_bc, border_bc);
        link(e1, f1);
        border_[e1] = border_[f1] = false;
        out_[a] = e;
        out_[b] = f;
        out_[c] = e2;
        out_[d] = f2;
    }

    void outer(Id e, Id twin, bool border) {
        twin_[e] = twin;
        border_[e] = border;
        if (twin != nil) {
            twin_[twin] = e;
        }
    }

    void toggle(Id e) {
        border_[e] = !border_[e];
        if (twin_[e] != nil) {
            border_[twin_[e]] = border_[e];
        }
    }

    // Calls visit(half edge that starts at a) for every triangle at a until it returns true.
    template <class Visit> void around(Id a, Visit visit) const {
        const Id first = out_[a];
        Id e = first;
        do {
            if (visit(e)) {
                return;
            }
            e = twin_[prev(e)];
        } while (e != nil && e != first);
        if (e == nil) { // a lies on the hull: the other way round
            for (e = twin_[first]; e != nil; e = twin_[e]) {
                e = next(e);
                if (visit(e)) {
                    return;
                }
            }
        }
    }

    [[nodiscard]] Id find(Id a, Id b) const {
        Id found = nil;
        around(a, [&](Id e) {
            found = vertex_[next(e)] == b ? e : vertex_[prev(e)] == b ? prev(e) : nil;
            return found != nil;
        });
        return found;
    }

    [[nodiscard]] bool on_way(Id a, Id b, Id v) const {
        return v == b || (side(a, b, v) == 0 && (p_[b].x - p_[a].x) * (p_[v].x - p_[a].x) +
                                                        (p_[b].y - p_[a].y) * (p_[v].y - p_[a].y) >
                                                    0);
    }

    [[nodiscard]] Crossing leave(Id a, Id b) const {
        Crossing c;
        around(a, [&](Id e) {
            const Id v = vertex_[next(e)], w = vertex_[prev(e)];
            if (on_way(a, b, v)) {
                c.along = e;
                c.target = v;
            } else if (on_way(a, b, w)) {
                c.along = prev(e);
                c.target = w;
            } else if (side(a, b, v) < 0 && side(a, b, w) > 0) {
                c.edge = next(e);
            }
            return c.along != nil || c.edge != nil;
        });
        return c;
    }

    // Flips away what crosses the way from a to b, up to the first point on it, which is returned;
    // nil if a border is in the way. [Sloan93] section 4.
    Id clear_way(Id a, Id b, Id edge) {
        std::deque<std::pair<Id, Id>> crossing; // by ends, as flips rename half edges
        Id target = b;
        for (Id e = edge;;) {
            if (border_[e]) {
                return nil;
            }
            crossing.emplace_back(vertex_[e], vertex_[next(e)]);
            const Id f = twin_[e];
            if (f == nil) {
                return nil; // cannot happen with exact signs
            }
            const Id x = vertex_[prev(f)];
            const double s = x == b ? 0 : side(a, b, x);
            if (s == 0) {
                target = x;
                break;
            }
            e = s > 0 ? next(f) : prev(f);
        }
        while (!crossing.empty()) {
            const auto [v, w] = crossing.front();
            crossing.pop_front();
            const Id e = find(v, w);
            if (e == nil || twin_[e] == nil || flips_left_ == 0) {
                return nil;
            }
            --flips_left_; // also counts waiting, so that the loop ends
            if (!can_flip(e)) {
                crossing.emplace_back(v, w);
                continue;
            }
            const Id c = vertex_[prev(e)], d = vertex_[prev(twin_[e])];
            ++flips_left_;
            flip(e);
            if (c != a && c != target && d != a && d != target &&
                (side(a, target, c) > 0) != (side(a, target, d) > 0)) {
                crossing.emplace_back(c, d);
            }
        }
        return target;
    }
};

// Points without repetition, in lexicographic order, and the way back.
struct Distinct {
    std::vector<Point2> points;
    std::vector<Id> original; // by distinct point: its first occurrence
    std::vector<Id> index;    // by input point

    explicit Distinct(std::span<const Point2> in) : index(in.size()) {
        std::vector<Id> order(in.size());
        std::iota(order.begin(), order.end(), 0);
        std::sort(order.begin(), order.end(), [&](Id a, Id b) {
            return in[a].x != in[b].x   ? in[a].x < in[b].x
                   : in[a].y != in[b].y ? in[a].y < in[b].y
                                        : a < b;
        });
        for (const Id i : order) {
            if (points.empty() || !(points.back() == in[i])) {
                points.push_back(in[i]);
                original.push_back(i);
            }
            index[i] = static_cast<Id>(points.size() - 1);
        }
    }
};

bool even_odd(std::span<const Point2> points, std::span<const Id> loop_sizes, const Point2& p) {
    bool odd = false;
    std::size_t first = 0;
    for (const Id n : loop_sizes) {
        for (std::size_t i = 0; i < n; ++i) {
            const Point2 &a = points[first + i], &b = points[first + (i + 1) % n];
            odd ^= (a.y > p.y) != (b.y > p.y) && (orient(a, b, p) > 0) == (b.y > a.y);
        }
        first += n;
    }
    return odd;
}

bool winds_clockwise(std::span<const Point2> points, std::span<const Id> loop_sizes) {
    double area = 0;
    for (std::size_t i = 1; !loop_sizes.empty() && i + 1 < loop_sizes[0]; ++i) {
        area += orient(points[0], points[i], points[i + 1]);
    }
    return area < 0;
}

} // namespace

Triangulation triangulate(std::span<const Point2> points,
                          std::span<const std::uint32_t> loop_sizes) {
    Triangulation result;
    const Distinct distinct(points);
    Mesh mesh(distinct.points);
    if (distinct.points.size() < 3 || !mesh.build()) {
        return result;
    }
    std::size_t first = 0;
    for (const Id n : loop_sizes) {
        for (std::size_t i = 0; i < n; ++i) {
            result.clean &=
                mesh.toggle_border(distinct.index[first + i], distinct.index[first + (i + 1) % n]);
        }
        first += n;
    }
    // Where outlines cross, no border separates the sides everywhere: look at each triangle's
    // centre, if there is time.
    constexpr std::uint64_t affordable = 100'000'000;
    const bool by_centre =
        !result.clean && mesh.num_triangles() * std::uint64_t(points.size()) <= affordable;
    const std::vector<bool> inside = mesh.inside();
    const bool clockwise = winds_clockwise(points, loop_sizes);
    for (std::size_t t = 0; t < mesh.num_triangles(); ++t) {
        const auto [a, b, c] = mesh.triangle(t);
        const Point2 &pa = distinct.points[a], &pb = distinct.points[b], &pc = distinct.points[c];
        const Point2 centre{(pa.x + pb.x + pc.x) / 3, (pa.y + pb.y + pc.y) / 3};
        if (by_centre ? even_odd(points, loop_sizes, centre) : inside[t]) {
            const Id i = distinct.original[a], j = distinct.original[b], k = distinct.original[c];
            result.triangles.push_back(clockwise ? std::array<Id, 3>{i, k, j}
                                                 : std::array<Id, 3>{i, j, k});
        }
    }
    return result;
}

} // namespace geo
