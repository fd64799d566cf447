// SPDX-License-Identifier: Apache-2.0
#include "geometry/triangulate.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <map>
#include <numbers>
#include <random>

namespace {

using geo::orient;
using geo::Point2;
using geo::triangulate;
using geo::Triangulation;

struct Outline {
    std::vector<Point2> points;
    std::vector<std::uint32_t> sizes;

    void add(const std::vector<Point2>& loop) {
        points.insert(points.end(), loop.begin(), loop.end());
        sizes.push_back(static_cast<std::uint32_t>(loop.size()));
    }
    // Even-odd rule, all loops.
    [[nodiscard]] bool inside(const Point2& p) const {
        bool odd = false;
        std::size_t first = 0;
        for (const std::uint32_t n : sizes) {
            for (std::size_t i = 0; i < n; ++i) {
                const Point2 &a = points[first + i], &b = points[first + (i + 1) % n];
                if ((a.y > p.y) != (b.y > p.y) &&
                    p.x < a.x + (p.y - a.y) * (b.x - a.x) / (b.y - a.y)) {
                    odd = !odd;
                }
            }
            first += n;
        }
        return odd;
    }
};

std::vector<Point2> star(std::mt19937& rng, Point2 centre, double inner, double outer, int n,
                         bool ccw) {
    std::uniform_real_distribution<double> radius(inner, outer);
    std::vector<Point2> loop;
    for (int i = 0; i < n; ++i) {
        const double a = 2 * std::numbers::pi * (ccw ? i : n - i) / n, r = radius(rng);
        loop.push_back({static_cast<float>(centre.x + r * std::cos(a)),
                        static_cast<float>(centre.y + r * std::sin(a))});
    }
    return loop;
}

int covering(const Outline& o, const Triangulation& t, const Point2& p) {
    int count = 0;
    for (const auto& tri : t.triangles) {
        const double a = orient(o.points[tri[0]], o.points[tri[1]], p);
        const double b = orient(o.points[tri[1]], o.points[tri[2]], p);
        const double c = orient(o.points[tri[2]], o.points[tri[0]], p);
        count += (a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0);
    }
    return count;
}

// Every random place is covered once if it is inside by the even-odd rule, and never otherwise.
void expect_coverage(const Outline& o, const Triangulation& t, double reach) {
    std::mt19937 rng(5);
    std::uniform_real_distribution<double> in(-reach, reach);
    for (int n = 0; n < 2000; ++n) {
        const Point2 p{in(rng), in(rng)};
        ASSERT_EQ(covering(o, t, p), o.inside(p) ? 1 : 0) << p.x << " " << p.y;
    }
}

double first_loop_area(const Outline& o) {
    double a = 0;
    for (std::size_t i = 1; i + 1 < o.sizes[0]; ++i) {
        a += orient(o.points[0], o.points[i], o.points[i + 1]);
    }
    return a;
}

void expect_winding(const Outline& o, const Triangulation& t) {
    const double sign = first_loop_area(o);
    for (const auto& tri : t.triangles) {
        EXPECT_GT(orient(o.points[tri[0]], o.points[tri[1]], o.points[tri[2]]) * sign, 0);
    }
}

TEST(Triangulate, ConcaveOutlines) {
    std::mt19937 rng(1);
    for (const int n : {4, 5, 7, 12, 50, 200}) {
        for (int k = 0; k < 5; ++k) {
            Outline o;
            o.add(star(rng, {0, 0}, 0.2, 1, n, k % 2 == 0));
            const Triangulation t = triangulate(o.points, o.sizes);
            EXPECT_TRUE(t.clean);
            EXPECT_EQ(t.triangles.size(), std::size_t(n - 2));
            expect_winding(o, t);
            expect_coverage(o, t, 1);
        }
    }
}

TEST(Triangulate, HolesOfAnyWinding) {
    std::mt19937 rng(2);
    for (int k = 0; k < 20; ++k) {
        Outline o;
        o.add(star(rng, {0, 0}, 2, 3, 40, k % 2 == 0));
        for (int i = 0; i < 6; ++i) {
            const double a = i * std::numbers::pi / 3 + k;
            o.add(star(rng, {1.3 * std::cos(a), 1.3 * std::sin(a)}, 0.1, 0.4, 9, i % 2 == 0));
        }
        o.add(star(rng, {0, 0}, 0.2, 0.5, 5, k % 3 == 0));
        const Triangulation t = triangulate(o.points, o.sizes);
        EXPECT_TRUE(t.clean);
        EXPECT_EQ(t.triangles.size(), o.points.size() + 2 * 7 - 2);
        expect_winding(o, t);
        expect_coverage(o, t, 3);
    }
}

// An island in a hole, and a second loop beside the first: filled by the even-odd rule.
TEST(Triangulate, NestedAndSeparateLoops) {
    std::mt19937 rng(3);
    Outline o;
    o.add(star(rng, {-3, 0}, 2, 2.5, 16, true));
    o.add(star(rng, {-3, 0}, 1, 1.5, 12, true));
    o.add(star(rng, {-3, 0}, 0.4, 0.8, 8, true));
    o.add(star(rng, {3, 0}, 1, 2, 9, false));
    const Triangulation t = triangulate(o.points, o.sizes);
    EXPECT_TRUE(t.clean);
    expect_coverage(o, t, 6);
    expect_winding(o, t);
}

// Points in the middle of straight edges stay corners of triangles: neighbours that use them meet
// without a crack.
TEST(Triangulate, KeepsStraightCorners) {
    Outline o;
    o.add({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 1}, {3, 2}, {1.5, 2}, {0, 2}, {0, 1}});
    const Triangulation t = triangulate(o.points, o.sizes);
    EXPECT_TRUE(t.clean);
    EXPECT_EQ(t.triangles.size(), 7u);
    std::vector<bool> used(o.points.size());
    for (const auto& tri : t.triangles) {
        for (const std::uint32_t i : tri) {
            used[i] = true;
        }
    }
    EXPECT_TRUE(std::all_of(used.begin(), used.end(), [](bool b) { return b; }));
    expect_coverage(o, t, 4);
}

// Inner edges are shared by exactly two triangles: no cracks, no overlaps.
TEST(Triangulate, EdgesPairUp) {
    std::mt19937 rng(4);
    Outline o;
    o.add(star(rng, {0, 0}, 2, 3, 60, true));
    o.add(star(rng, {0.2, 0.1}, 0.5, 1.2, 30, true));
    const Triangulation t = triangulate(o.points, o.sizes);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const auto& tri : t.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            ++edges[{tri[k], tri[(k + 1) % 3]}];
        }
    }
    int border = 0;
    for (const auto& [edge, count] : edges) {
        EXPECT_EQ(count, 1);
        border += !edges.contains({edge.second, edge.first});
    }
    EXPECT_EQ(border, 90);
}

TEST(Triangulate, ClosedAndRepeatedPoints) {
    Outline o;
    o.add({{0, 0}, {0, 0}, {2, 0}, {2, 0}, {1, 0.5}, {2, 2}, {0, 2}, {0, 0}});
    const Triangulation t = triangulate(o.points, o.sizes);
    EXPECT_EQ(t.triangles.size(), 3u);
    expect_coverage(o, t, 3);
}

// Outlines that touch without crossing: exporters cut holes open along a bridge, and outlines of
// letters and maps meet at points.
TEST(Triangulate, TouchingOutlines) {
    const std::vector<Point2> square{{-3, -3}, {3, -3}, {3, 3}, {-3, 3}};
    std::vector<Outline> outlines(6);
    // A hole cut open: in along an edge, round, and back along the same edge.
    outlines[0].add({{-3, -3},
                     {3, -3},
                     {3, 3},
                     {-3, 3},
                     {-3, -3},
                     {-1, -1},
                     {-1, 1},
                     {1, 1},
                     {1, -1},
                     {-1, -1}});
    // A hole that touches the outline at a corner, and one in the middle of an edge.
    outlines[1].add(square);
    outlines[1].add({{-3, -3}, {0, 1}, {1, 0}});
    outlines[2].add({{-3, -3}, {0, -3}, {3, -3}, {3, 3}, {-3, 3}});
    outlines[2].add({{0, -3}, {-1, 1}, {1, 1}});
    // Two holes that touch each other.
    outlines[3].add(square);
    outlines[3].add({{0, 0}, {-2, -1}, {-2, 1}});
    outlines[3].add({{0, 0}, {2, 1}, {2, -1}});
    // An outline that pinches itself.
    outlines[4].add({{-3, -3}, {3, -3}, {0, 0}, {3, 3}, {-3, 3}, {0, 0}});
    // Two islands that meet in a point.
    outlines[5].add({{-3, -1}, {0, 0}, {-3, 1}});
    outlines[5].add({{3, -1}, {0, 0}, {3, 1}});
    for (std::size_t i = 0; i < outlines.size(); ++i) {
        SCOPED_TRACE(i);
        const Outline& o = outlines[i];
        for (std::size_t turn = 0; turn < o.sizes[0]; ++turn) { // wherever the first loop starts
            Outline turned = o;
            std::rotate(turned.points.begin(),
                        turned.points.begin() + static_cast<std::ptrdiff_t>(turn),
                        turned.points.begin() + o.sizes[0]);
            const Triangulation t = triangulate(turned.points, turned.sizes);
            EXPECT_TRUE(t.clean) << turn;
            expect_coverage(turned, t, 3);
        }
    }
}

TEST(Triangulate, DegenerateInputGivesNothing) {
    EXPECT_TRUE(triangulate({}, {}).triangles.empty());
    const std::vector<Point2> line{{0, 0}, {1, 1}, {2, 2}, {3, 3}};
    const std::vector<std::uint32_t> four{4}, zero{0, 4}, two{2, 2};
    EXPECT_TRUE(triangulate(line, four).triangles.empty());
    EXPECT_TRUE(triangulate(line, zero).triangles.empty());
    EXPECT_TRUE(triangulate(line, two).triangles.empty());
}

// Crossing outlines and points on a coarse lattice: any answer, but an answer, and in time.
TEST(Triangulate, NeverFails) {
    std::mt19937 rng(6);
    std::uniform_int_distribution<int> lattice(0, 6), count(3, 40), loops(1, 5);
    for (int n = 0; n < 3000; ++n) {
        Outline o;
        for (int k = loops(rng); k > 0; --k) {
            std::vector<Point2> loop;
            for (int i = count(rng); i > 0; --i) {
                loop.push_back({double(lattice(rng)), double(lattice(rng))});
            }
            o.add(loop);
        }
        const Triangulation t = triangulate(o.points, o.sizes);
        EXPECT_LE(t.triangles.size(), o.points.size() + 2 * o.sizes.size());
        for (const auto& tri : t.triangles) {
            EXPECT_TRUE(tri[0] < o.points.size() && tri[1] < o.points.size() &&
                        tri[2] < o.points.size());
        }
    }
}

TEST(Triangulate, LargeOutlineInTime) {
    std::mt19937 rng(7);
    Outline o;
    o.add(star(rng, {0, 0}, 2, 2.2, 50000, true));
    o.add(star(rng, {0, 0}, 1, 1.2, 50000, true));
    const Triangulation t = triangulate(o.points, o.sizes);
    EXPECT_EQ(t.triangles.size(), 100000u);
}

} // namespace
