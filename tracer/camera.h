// SPDX-License-Identifier: Apache-2.0
// The camera of one frame: spaces from camera to raster, pixel ranges, and the rays of samples.
//
// In: rib::Options and the camera transforms of a Scene. Out: matrices in double, geo::RayPackets
// in camera space. Every projection, with any transformation before it, is handled as one
// projective map: its inverse gives the one point all rays pass through (the eye, or a direction),
// see film-001. Immutable; safe from any thread. Source: ri.md 6.3, 8.3, 8.4, 9.6.
#pragma once

#include "geometry/hit.h"
#include "geometry/world.h"
#include "ribtools/scene.h"
#include "runtime/base/diag.h"
#include "runtime/base/mat.h"
#include "tracer/pixel_range.h"

#include <span>
#include <vector>

namespace trace {

struct SampleBlock;

// Pixels of the frame. `picture` is the upper left part that FrameAspectRatio leaves (all of it by
// default); the strip beyond it stays empty. `crop` is CropWindow's range, ri.md 6.3; it may be
// empty.
struct Raster {
    int xres = 640, yres = 480;
    double pixel_aspect = 1;
    PixelRange frame, picture, crop;
    double screen_left = -1, screen_right = 1, screen_bottom = -1, screen_top = 1;

    // The pixels that are rendered.
    [[nodiscard]] PixelRange rendered() const { return crop.intersected(picture); }
};

// Resolves Format, FrameAspectRatio, ScreenWindow and CropWindow; impossible values are reported
// and replaced.
[[nodiscard]] Raster make_raster(const rib::Options& options, base::Diag& diag);
// The inclusive range of ri.md 6.3 along one axis, as [first, last + 1).
struct CropSpan {
    int begin, end;
};
[[nodiscard]] CropSpan crop_span(int resolution_px, float min, float max);

class Camera {
public:
    // The scene's transforms are taken at shutter open; bad values are reported and replaced by
    // documented ones.
    Camera(const rib::Scene& scene, base::Diag& diag);

    [[nodiscard]] const Raster& raster() const { return raster_; }
    // Rays meet in an eye point; otherwise they are parallel.
    [[nodiscard]] bool perspective() const { return perspective_; }
    [[nodiscard]] double near_clip() const { return near_; }
    [[nodiscard]] double far_clip() const { return far_; } // infinity from RI_INFINITY on
    // Lens radius in camera units; 0 is the pinhole.
    [[nodiscard]] double lens_radius() const { return lens_radius_; }

    // Spaces. Screen z runs from 0 at the near to 1 at the far plane; NDC is 0..1 over the picture,
    // y down. Raster and NDC keep screen's z. Use base::point, which divides by w.
    [[nodiscard]] const base::Mat4& camera_from_world() const { return camera_from_world_; }
    [[nodiscard]] const base::Mat4& screen_from_camera() const { return screen_from_camera_; }
    [[nodiscard]] const base::Mat4& ndc_from_screen() const { return ndc_from_screen_; }
    [[nodiscard]] const base::Mat4& raster_from_screen() const { return raster_from_screen_; }
    [[nodiscard]] base::Mat4 ndc_from_camera() const;
    [[nodiscard]] base::Mat4 raster_from_camera() const;
    [[nodiscard]] base::Mat4 camera_from_raster() const;
    [[nodiscard]] base::Mat4 ndc_from_world() const;

    // What dicing asks for. Exact for the standard projections.
    [[nodiscard]] geo::View view() const;

    // Rays of all samples of a block, in order, eight to a packet; the last packet is filled up
    // with inactive lanes. t is camera z for the standard projections; tnear/tfar hold Clipping and
    // ClippingPlane. A ray whose interval is empty is inactive. packets must hold
    // block.num_packets().
    void make_rays(const SampleBlock& block, std::span<geo::RayPacket> packets) const;

    struct Ray {
        base::V3d origin, direction;
        double tnear = 0, tfar = 0; // empty: tnear > tfar
    };
    // The pinhole ray through a raster position, in double: the reference of make_rays, and for
    // tools.
    [[nodiscard]] Ray pinhole_ray(double x_px, double y_px) const;

    // Distance between shading samples that lie spacing_px pixels apart, at camera depth z.
    // Perpendicular to the view direction; the mean of x and y (design.md, section 5).
    [[nodiscard]] float footprint(float z_cam, float spacing_px) const;
    // Diameter of the disc that the lens makes of a point at camera depth z, pixels.
    [[nodiscard]] float blur_px(float z_cam) const;

private:
    struct Plane { // n.P <= d is kept, camera space
        base::V3d n;
        double d = 0;
    };
    // Rays as affine functions of the raster position: v = v0 + x vx + y vy.
    struct Affine {
        base::V3d v0, vx, vy;
        [[nodiscard]] base::V3d at(double x, double y) const { return v0 + x * vx + y * vy; }
    };
    void init_projection(const rib::Scene& scene, base::Diag& diag);
    [[nodiscard]] bool init_rays(const base::Mat4& screen_from_camera);
    void normalise_depth();
    void init_lens(const rib::Options& options, base::Diag& diag);
    void init_planes(const rib::Options& options);
    void clip(Ray& ray) const;
    void clip_half_space(Ray& ray, const Plane& plane) const;
    [[nodiscard]] Ray lens_ray(Ray ray, float lens_x, float lens_y) const;
    void make_simple_packet(const SampleBlock& block, std::size_t first, geo::RayPacket& out) const;
    void add_lens(const SampleBlock& block, std::size_t first, geo::RayPacket& out) const;
    void make_general_packet(const SampleBlock& block, std::size_t first,
                             geo::RayPacket& out) const;

    Raster raster_;
    bool perspective_ = false;
    bool simple_ = true; // origin z = 0, direction z = 1, no planes: the vectorised path
    double near_ = 0, far_ = 0;
    double lens_radius_ = 0, focal_distance_ = 0;
    float unit_per_px_ = 1;
    base::Mat4 camera_from_world_, screen_from_camera_, ndc_from_screen_, raster_from_screen_;
    Affine origin_, direction_;
    base::V3d origin_w_{1, 0,
                        0}; // parallel rays under a projective map: origin / (w.x + x w.y + y w.z)
    std::vector<Plane> planes_;
};

} // namespace trace
