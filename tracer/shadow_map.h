// SPDX-License-Identifier: Apache-2.0
// Shadow maps: depths seen from a light, and percentage-closer filtering of comparisons with them
// [Reeves87]. In: a point and its differences in the space the map is asked from. Out: the share of
// the footprint that lies in shadow, 0..1. What a point gets depends on the point alone. Immutable.
// Decisions: docs/design/textures.md.
#pragma once

#include "runtime/base/mat.h"
#include "runtime/base/vec.h"
#include "tracer/map_file.h"

#include <vector>

namespace trace {

struct ShadowOptions {
    double width[2] = {1, 1}; // of the footprint, in s and t
    double blur[2] = {0, 0};  // added to it, fractions of the map
    double bias[2] = {0, 0};  // least and largest
    bool has_bias = false;    // else the map's own tolerance decides
    int samples = 16;
};

class ShadowMap {
public:
    // The image has matrices and one channel that counts.
    explicit ShadowMap(const MapImage& image);

    // The map as seen from another space: made once per frame.
    struct View {
        base::Mat4 camera_from_current, screen_from_current;
        base::V3d light; // the map's eye, or the direction towards a parallel one
    };
    [[nodiscard]] View view(const base::Mat4& world_from_current) const;

    [[nodiscard]] double shadow(const View& view, const base::V3d& P, const base::V3d& P_u,
                                const base::V3d& P_v, const ShadowOptions& options) const;
    // Unit vector from P to where the map looks from.
    [[nodiscard]] base::V3d to_light(const View& view, const base::V3d& P) const;

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }
    [[nodiscard]] std::size_t bytes() const { return depth_.size() * sizeof(float); }

private:
    // A point on the map: place in texels, and what is linear in it along a plane: 1/z where rays
    // meet, z where they are parallel.
    struct Spot {
        double x = 0, y = 0, key = 0, z = 0;
        bool ahead = false; // in front of the light
    };
    struct Footprint;
    [[nodiscard]] Spot project(const View& view, const base::V3d& P) const;
    [[nodiscard]] Footprint footprint(const View& view, const Spot& at, const base::V3d& P,
                                      const base::V3d& P_u, const base::V3d& P_v,
                                      const ShadowOptions& options) const;
    [[nodiscard]] bool hides(const Footprint& f, long x, long y, double random) const;
    [[nodiscard]] double few_texels(const Footprint& f) const;
    [[nodiscard]] double many_texels(const Footprint& f, int samples) const;

    int width_, height_;
    std::vector<float> depth_;
    base::Mat4 camera_from_world_, screen_from_world_;
    bool perspective_ = true;
    double texel_ = 0; // width of a texel at z = 1, or anywhere if parallel
};

} // namespace trace
