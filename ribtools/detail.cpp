// SPDX-License-Identifier: Apache-2.0
#include "ribtools/detail.h"

#include "ribtools/number.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace rib {

namespace {

using base::V3d;

struct Point2 {
    double x, y;
};

double cross(const Point2& o, const Point2& a, const Point2& b) {
    return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

// Area of the convex hull: Andrew's monotone chain, then the shoelace formula.
double hull_area(std::vector<Point2> points) {
    if (points.size() < 3) {
        return 0;
    }
    std::sort(points.begin(), points.end(), [](const Point2& a, const Point2& b) {
        return a.x < b.x || (a.x == b.x && a.y < b.y);
    });
    std::vector<Point2> hull;
    for (int pass = 0; pass < 2; ++pass) {
        const std::size_t base_size = hull.size() + 1;
        for (const Point2& p : points) {
            while (hull.size() > base_size && cross(hull[hull.size() - 2], hull.back(), p) <= 0) {
                hull.pop_back();
            }
            hull.push_back(p);
        }
        hull.pop_back();
        std::reverse(points.begin(), points.end());
    }
    double twice = 0;
    for (std::size_t i = 0; i < hull.size(); ++i) {
        const Point2 &a = hull[i], &b = hull[(i + 1) % hull.size()];
        twice += a.x * b.y - a.y * b.x;
    }
    return std::fabs(twice) / 2;
}

// The box's corners and the points where its edges cross the near plane, in front of it.
std::vector<V3d> visible_points(const base::Mat4& cam_from_box, const std::array<double, 6>& bound,
                                double near_clip) {
    std::vector<V3d> corners, visible;
    for (unsigned i = 0; i < 8; ++i) {
        corners.push_back(base::point(
            cam_from_box, {bound[i & 1], bound[2 + ((i >> 1) & 1)], bound[4 + ((i >> 2) & 1)]}));
    }
    for (unsigned i = 0; i < 8; ++i) {
        if (corners[i].z >= near_clip) {
            visible.push_back(corners[i]);
        }
        for (unsigned axis = 1; axis < 8; axis <<= 1) {
            const V3d &a = corners[i], &b = corners[i ^ axis];
            if (a.z < near_clip && b.z >= near_clip) {
                visible.push_back(a + (b - a) * ((near_clip - a.z) / (b.z - a.z)));
            }
        }
    }
    return visible;
}

} // namespace

float raster_area(const Options& o, const base::Mat4& cam_from_box,
                  const std::array<double, 6>& bound) {
    const bool perspective = o.projection == "perspective";
    const double tan_half = std::tan(static_cast<double>(o.fov_deg) * std::numbers::pi / 360);
    const auto [l, r, b, t] = o.screen_window;
    const double scale_x = o.xres / static_cast<double>(r - l);
    const double scale_y = o.yres / static_cast<double>(t - b);
    std::vector<Point2> raster;
    for (const V3d& P : visible_points(cam_from_box, bound, static_cast<double>(o.near_clip))) {
        const double w = perspective ? P.z * tan_half : 1;
        raster.push_back({P.x / w * scale_x, P.y / w * scale_y});
    }
    const double area = hull_area(std::move(raster));
    return std::isfinite(area) ? narrow(area) : ri_infinity;
}

} // namespace rib
