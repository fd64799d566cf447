// SPDX-License-Identifier: Apache-2.0
#include "geometry/triangulate.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace geo {

namespace {

constexpr std::uint32_t nil = std::numeric_limits<std::uint32_t>::max();

struct Node {
    Point2 p;
    std::uint32_t point; // index into the caller's points
    std::uint32_t prev, next;
    bool removed = false;
};

struct Loop {
    std::uint32_t start = nil; // any node of the ring
    double area2 = 0;          // twice the signed area
    Point2 lo{}, hi{};
    std::uint32_t leftmost = nil;
    int depth = 0;
    std::uint32_t parent = nil;
};

bool in_triangle(const Point2& a, const Point2& b, const Point2& c, const Point2& p) {
    return orient(a, b, p) >= 0 && orient(b, c, p) >= 0 && orient(c, a, p) >= 0;
}

// Buckets of the reflex corners, so that an ear looks only at those near it.
class ReflexGrid {
public:
    void build(std::span<const Node> nodes, std::span<const std::uint32_t> reflex) {
        lo_ = {1e300, 1e300};
        Point2 hi{-1e300, -1e300};
        for (const std::uint32_t i : reflex) {
            lo_ = {std::min(lo_.x, nodes[i].p.x), std::min(lo_.y, nodes[i].p.y)};
            hi = {std::max(hi.x, nodes[i].p.x), std::max(hi.y, nodes[i].p.y)};
        }
        side_ =
            std::clamp(static_cast<int>(std::sqrt(static_cast<double>(reflex.size()))), 1, 1024);
        scale_ = {side_ / std::max(hi.x - lo_.x, 1e-300), side_ / std::max(hi.y - lo_.y, 1e-300)};
        start_.assign(static_cast<std::size_t>(side_) * side_ + 1, 0);
        for (const std::uint32_t i : reflex) {
            ++start_[cell(nodes[i].p) + 1];
        }
        for (std::size_t i = 1; i < start_.size(); ++i) {
            start_[i] += start_[i - 1];
        }
        items_.resize(reflex.size());
        std::vector<std::uint32_t> fill(start_.begin(), start_.end() - 1);
        for (const std::uint32_t i : reflex) {
            items_[fill[cell(nodes[i].p)]++] = i;
        }
    }

    // Calls visit(node) for corners that may lie in the box until it returns true.
    template <class Visit> bool any(const Point2& lo, const Point2& hi, Visit visit) const {
        for (int y = row(lo.y); y <= row(hi.y); ++y) {
            for (int x = column(lo.x); x <= column(hi.x); ++x) {
                const std::size_t c = static_cast<std::size_t>(y) * side_ + x;
                for (std::uint32_t k = start_[c]; k < start_[c + 1]; ++k) {
                    if (visit(items_[k])) {
                        return true;
                    }
                }
            }
        }
        return false;
    }

private:
    Point2 lo_{}, scale_{};
    int side_ = 1;
    std::vector<std::uint32_t> start_, items_;

    [[nodiscard]] int bucket(double x) const {
        return static_cast<int>(std::clamp(x, 0.0, side_ - 1.0));
    }
    [[nodiscard]] int column(double x) const { return bucket((x - lo_.x) * scale_.x); }
    [[nodiscard]] int row(double y) const { return bucket((y - lo_.y) * scale_.y); }
    [[nodiscard]] std::size_t cell(const Point2& p) const {
        return static_cast<std::size_t>(row(p.y)) * side_ + column(p.x);
    }
};

class Clipper {
public:
    Clipper(std::span<const Point2> points, std::span<const std::uint32_t> loop_sizes) {
        nodes_.reserve(points.size() + 2 * loop_sizes.size());
        std::uint32_t first = 0;
        for (const std::uint32_t size : loop_sizes) {
            add_loop(points, first, size);
            first += size;
        }
    }

    Triangulation run() {
        if (loops_.empty()) {
            return std::move(result_);
        }
        nest();
        const bool first_is_ccw = loops_.front().area2 > 0;
        for (std::uint32_t i = 0; i < loops_.size(); ++i) {
            if (loops_[i].depth % 2 == 0) {
                clip(bridged(i));
            }
        }
        if (!first_is_ccw) {
            for (auto& t : result_.triangles) {
                std::swap(t[1], t[2]);
            }
        }
        return std::move(result_);
    }

private:
    std::vector<Node> nodes_;
    std::vector<Loop> loops_;
    Triangulation result_;

    [[nodiscard]] const Node& next(std::uint32_t i) const { return nodes_[nodes_[i].next]; }
    [[nodiscard]] const Node& prev(std::uint32_t i) const { return nodes_[nodes_[i].prev]; }
    [[nodiscard]] double corner(std::uint32_t i) const {
        return orient(prev(i).p, nodes_[i].p, next(i).p);
    }

    // Drops repeated points; loops of fewer than three, or without area, are left out.
    void add_loop(std::span<const Point2> points, std::uint32_t first, std::uint32_t size) {
        const auto base = static_cast<std::uint32_t>(nodes_.size());
        for (std::uint32_t i = first; i < first + size; ++i) {
            if (nodes_.size() == base || !(nodes_.back().p == points[i])) {
                nodes_.push_back({points[i], i, 0, 0});
            }
        }
        while (nodes_.size() > base + 1 && nodes_.back().p == nodes_[base].p) {
            nodes_.pop_back();
        }
        const auto count = static_cast<std::uint32_t>(nodes_.size()) - base;
        Loop loop;
        loop.start = loop.leftmost = base;
        loop.lo = loop.hi = nodes_[base].p;
        for (std::uint32_t k = 0; k < count; ++k) {
            Node& n = nodes_[base + k];
            n.prev = base + (k + count - 1) % count;
            n.next = base + (k + 1) % count;
            loop.lo = {std::min(loop.lo.x, n.p.x), std::min(loop.lo.y, n.p.y)};
            loop.hi = {std::max(loop.hi.x, n.p.x), std::max(loop.hi.y, n.p.y)};
            loop.area2 += orient(nodes_[base].p, n.p, nodes_[n.next].p);
            const Point2& best = nodes_[loop.leftmost].p;
            if (n.p.x < best.x || (n.p.x == best.x && n.p.y < best.y)) {
                loop.leftmost = base + k;
            }
        }
        if (count < 3 || loop.area2 == 0) {
            nodes_.resize(base);
        } else {
            loops_.push_back(loop);
        }
    }

    void reverse(std::uint32_t start) {
        std::uint32_t i = start;
        do {
            std::swap(nodes_[i].prev, nodes_[i].next);
            i = nodes_[i].prev;
        } while (i != start);
    }

    [[nodiscard]] bool inside(const Point2& p, const Loop& loop) const {
        if (p.x < loop.lo.x || p.x > loop.hi.x || p.y < loop.lo.y || p.y > loop.hi.y) {
            return false;
        }
        bool odd = false;
        std::uint32_t i = loop.start;
        do {
            const Point2 &a = nodes_[i].p, &b = next(i).p;
            if ((a.y > p.y) != (b.y > p.y) && (orient(a, b, p) > 0) == (b.y > a.y)) {
                odd = !odd;
            }
            i = nodes_[i].next;
        } while (i != loop.start);
        return odd;
    }

    // Depth of a loop = number of loops around it; the parent is the innermost of them.
    void nest() {
        constexpr std::uint64_t budget =
            200'000'000; // point-in-loop steps, against hostile loop counts
        if (loops_.size() * std::uint64_t(nodes_.size()) > budget) {
            for (std::uint32_t i = 1; i < loops_.size(); ++i) {
                loops_[i].depth = 1;
                loops_[i].parent = 0;
            }
            result_.clean = false;
        } else if (loops_.size() > 1) {
            nest_by_containment();
        }
        for (Loop& loop : loops_) {
            const bool want_ccw = loop.depth % 2 == 0;
            if ((loop.area2 > 0) != want_ccw) {
                reverse(loop.start);
            }
        }
    }

    void nest_by_containment() {
        for (std::uint32_t i = 0; i < loops_.size(); ++i) {
            double smallest = std::numeric_limits<double>::infinity();
            for (std::uint32_t j = 0; j < loops_.size(); ++j) {
                const double area = std::fabs(loops_[j].area2);
                if (i != j && area >= std::fabs(loops_[i].area2) &&
                    inside(nodes_[loops_[i].leftmost].p, loops_[j])) {
                    ++loops_[i].depth;
                    if (area < smallest) {
                        smallest = area;
                        loops_[i].parent = j;
                    }
                }
            }
        }
    }

    // The ring of a filled loop with its holes joined to it.
    std::uint32_t bridged(std::uint32_t outer) {
        std::vector<std::uint32_t> holes;
        for (std::uint32_t i = 0; i < loops_.size(); ++i) {
            if (loops_[i].parent == outer && loops_[i].depth == loops_[outer].depth + 1) {
                holes.push_back(loops_[i].leftmost);
            }
        }
        std::sort(holes.begin(), holes.end(), [&](std::uint32_t a, std::uint32_t b) {
            return nodes_[a].p.x != nodes_[b].p.x ? nodes_[a].p.x < nodes_[b].p.x : a < b;
        });
        const std::uint32_t ring = loops_[outer].start;
        for (const std::uint32_t hole : holes) {
            const std::uint32_t to = find_bridge(nodes_[hole].p, ring);
            if (to == nil) {
                result_.clean = false;
            } else {
                join(to, hole);
            }
        }
        return ring;
    }

    // A corner of the ring that the hole's leftmost point sees: the ray to the left meets an edge,
    // whose left end is visible unless reflex corners lie in between; of those the one nearest to
    // the ray is.
    [[nodiscard]] std::uint32_t find_bridge(const Point2& h, std::uint32_t ring) const {
        double reach = -std::numeric_limits<double>::infinity();
        std::uint32_t best = nil, i = ring;
        do {
            const Point2 &a = nodes_[i].p, &b = next(i).p;
            if (a.y >= h.y && h.y >= b.y &&
                a.y != b.y) { // the inside is to the right of a falling edge
                const double x = a.x + (h.y - a.y) * (b.x - a.x) / (b.y - a.y);
                if (x <= h.x && x > reach) {
                    reach = x;
                    best = a.x < b.x ? i : nodes_[i].next;
                    if (a == h || b == h) {
                        return a == h ? i : nodes_[i].next;
                    }
                }
            }
            i = nodes_[i].next;
        } while (i != ring);
        return best == nil ? nil : nearest_visible(h, reach, best, ring);
    }

    [[nodiscard]] std::uint32_t nearest_visible(const Point2& h, double reach, std::uint32_t best,
                                                std::uint32_t ring) const {
        const Point2 m = nodes_[best].p, q{reach, h.y};
        double least = std::numeric_limits<double>::infinity();
        std::uint32_t i = ring;
        do {
            const Point2& p = nodes_[i].p;
            if (p.x < h.x && p.x >= m.x && in_either(h, q, m, p) && sees(i, h)) {
                const double slope = std::fabs(h.y - p.y) / (h.x - p.x);
                if (slope < least || (slope == least && p.x > nodes_[best].p.x)) {
                    least = slope;
                    best = i;
                }
            }
            i = nodes_[i].next;
        } while (i != ring);
        return best;
    }

    [[nodiscard]] static bool in_either(const Point2& a, const Point2& b, const Point2& c,
                                        const Point2& p) {
        return in_triangle(a, b, c, p) || in_triangle(a, c, b, p);
    }

    // Whether the segment from node i to p starts into the inside of the ring.
    [[nodiscard]] bool sees(std::uint32_t i, const Point2& p) const {
        const Point2 &a = prev(i).p, &b = nodes_[i].p, &c = next(i).p;
        return orient(a, b, c) > 0 ? orient(a, b, p) >= 0 && orient(b, c, p) >= 0
                                   : orient(a, b, p) >= 0 || orient(b, c, p) >= 0;
    }

    // Cuts the region open along a - b: both rings become one.
    void join(std::uint32_t a, std::uint32_t b) {
        const auto a2 = static_cast<std::uint32_t>(nodes_.size()), b2 = a2 + 1;
        const std::uint32_t after_a = nodes_[a].next, before_b = nodes_[b].prev;
        nodes_.push_back({nodes_[a].p, nodes_[a].point, b2, after_a});
        nodes_.push_back({nodes_[b].p, nodes_[b].point, before_b, a2});
        nodes_[after_a].prev = a2;
        nodes_[before_b].next = b2;
        nodes_[a].next = b;
        nodes_[b].prev = a;
    }

    void clip(std::uint32_t ring) {
        std::vector<std::uint32_t> reflex;
        std::size_t left = 0;
        std::uint32_t i = ring;
        do {
            ++left;
            if (corner(i) <= 0) {
                reflex.push_back(i);
            }
            i = nodes_[i].next;
        } while (i != ring);
        ReflexGrid grid;
        grid.build(nodes_, reflex);

        std::size_t since_ear = 0;
        while (left > 3) {
            const bool stuck = since_ear > left; // a whole round without an ear
            const double turn = corner(i);
            // Straight corners are kept as long as there are ears: dropping one would open a crack
            // to a neighbour.
            const bool ear = turn > 0 ? stuck || is_ear(i, grid) : stuck && turn == 0;
            if (ear || since_ear > 2 * left) {
                result_.clean = result_.clean && !stuck;
                i = cut(i, turn);
                --left;
                since_ear = 0;
            } else {
                i = nodes_[i].next;
                ++since_ear;
            }
        }
        emit(i, corner(i));
    }

    // Takes the corner off the ring; returns where to go on: one further, which avoids thin fans.
    std::uint32_t cut(std::uint32_t i, double turn) {
        emit(i, turn);
        const std::uint32_t before = nodes_[i].prev, after = nodes_[i].next;
        nodes_[before].next = after;
        nodes_[after].prev = before;
        nodes_[i].removed = true;
        return nodes_[after].next;
    }

    void emit(std::uint32_t i, double turn) {
        if (turn > 0) {
            result_.triangles.push_back({prev(i).point, nodes_[i].point, next(i).point});
        }
    }

    // No other corner of the ring inside. Corners that were convex stay so, hence the grid of
    // reflex ones is enough.
    [[nodiscard]] bool is_ear(std::uint32_t i, const ReflexGrid& grid) const {
        const std::uint32_t ia = nodes_[i].prev, ic = nodes_[i].next;
        const Point2 &a = nodes_[ia].p, &b = nodes_[i].p, &c = nodes_[ic].p;
        const Point2 lo{std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y})};
        const Point2 hi{std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y})};
        return !grid.any(lo, hi, [&](std::uint32_t k) {
            const Node& n = nodes_[k];
            return !n.removed && k != ia && k != i && k != ic && corner(k) <= 0 &&
                   in_triangle(a, b, c, n.p) && !touches_only(k, a, b, c);
        });
    }

    // A corner at the same place as one of the ear's (bridges double their ends) blocks the ear
    // only if its edges lead into it.
    [[nodiscard]] bool touches_only(std::uint32_t k, const Point2& a, const Point2& b,
                                    const Point2& c) const {
        const Point2& p = nodes_[k].p;
        if (!(p == a || p == b || p == c)) {
            return false;
        }
        return !strictly_inside(a, b, c, prev(k).p) && !strictly_inside(a, b, c, next(k).p);
    }

    [[nodiscard]] static bool strictly_inside(const Point2& a, const Point2& b, const Point2& c,
                                              const Point2& p) {
        return orient(a, b, p) > 0 && orient(b, c, p) > 0 && orient(c, a, p) > 0;
    }
};

} // namespace

Triangulation triangulate(std::span<const Point2> points,
                          std::span<const std::uint32_t> loop_sizes) {
    return Clipper(points, loop_sizes).run();
}

} // namespace geo
