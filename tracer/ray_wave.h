// SPDX-License-Identifier: Apache-2.0
// Questions of shaders to rays, answered many at once: the queries of packets in, secondary rays,
// their colours, answers written into the queries. Rays go out in waves of bounded size, sorted by
// direction; what they meet is shaded in one call, so that lanes fill up by shader. One per ray
// level and thread. Answers do not depend on what is asked together (trace-017).
#pragma once

#include "tracer/ray_directions.h"
#include "tracer/ray_layers.h"
#include "tracer/ray_options.h"
#include "tracer/ray_packets.h"

#include <cstdint>
#include <span>
#include <vector>

namespace trace {

struct RayAsk {
    sl_ray_query* query = nullptr;
    const Execution* execution = nullptr;
};

class RayWave : private ShadeObserver {
public:
    // Rays traced and shaded together, at most: bounds memory.
    static constexpr std::size_t max_rays = 8192;

    RayWave(const FrameContext& frame, RayLayers& layers, ThreadState& thread);

    // Of kinds trace, fulltrace, hittest, gather; what else batches ask goes to answer_rays().
    void answer(std::span<const RayAsk> asks);
    void answer(std::span<ShadeJob* const> waiting);

private:
    struct Ray {
        PlainRay ray; // unit direction
        RayCone cone;
        MediumId medium = 0;
        std::uint32_t ask = 0, lane = 0, seed = 0;
        int number = 0;                // among those of its lane
        std::uint32_t of_sample = ~0U; // of the bucket, for --trace-pixel
    };
    // Where a lane stands.
    struct Place {
        const Execution* execution = nullptr;
        std::size_t point = 0;         // of the subject
        const geo::Hit* hit = nullptr; // null: on no surface
        std::uint32_t seed = 0;
    };
    // What a lane's rays have in common.
    struct Cone {
        base::V3d axis;
        double half_angle = 0;
        int samples = 1;
        ConeSample which;
        RayCone width;
    };
    void begin_answer(sl_ray_query& query) const;
    void add_rays(std::uint32_t ask);
    void add_lane(std::uint32_t ask, std::uint32_t lane);
    void add_ray(const Place& place, const Cone& cone, Ray ray);
    [[nodiscard]] Cone cone_of(const sl_ray_query& query, std::uint32_t lane,
                               const Place& place) const;
    void too_deep(const RayAsk& ask, std::uint32_t lane);
    [[nodiscard]] Place place_of(const RayAsk& ask, std::uint32_t lane) const;
    [[nodiscard]] base::V3f origin(const RayAsk& ask, std::uint32_t lane, const Place& place,
                                   const base::V3f& direction) const;
    [[nodiscard]] RayCone width(const sl_ray_query& query, std::uint32_t lane, const Place& place,
                                const base::V3d& direction, double length) const;
    [[nodiscard]] MediumId medium(const Place& place, const base::V3f& direction) const;

    void starting(ShadeJob& job) override;
    [[nodiscard]] bool sends() const override { return is_sending_; }
    void finished(ShadeJob& job) override;

    // The rays so far, traced together.
    void flush();
    void sort_rays();
    void trace(bool shaded);
    void fold(const Ray& ray, std::size_t slot);
    void fold_hit(const Ray& ray, const geo::Hit& hit);
    void fold_channels(const Ray& ray, std::size_t slot);
    [[nodiscard]] base::Color environment(const Ray& ray) const;
    void end_answer(std::size_t index);
    void tell(const RayAsk& ask, std::uint32_t lane) const;
    static void note_miss(const BatchSubject& subject, const sl_ray_query& query,
                          std::uint32_t lane);

    const FrameContext& frame_;
    RayLayers& layers_;
    ThreadState& thread_;
    std::span<const RayAsk> asks_;
    std::vector<RayAsk> waiting_asks_;
    std::vector<std::uint32_t> hits_of_lane_; // rays that met something: ask by ask
    RayFilter filter_;                        // of the rays so far
    bool shades_ = true;
    bool is_sending_ = false, has_channels_ = false;
    std::vector<Ray> rays_;
    // By slot: rays as they are traced.
    std::vector<std::uint32_t> order_;
    std::vector<geo::RayPacket> packets_;
    std::vector<std::uint32_t> seeds_, samples_;
    std::vector<RayCone> cones_;
    std::vector<MediumId> media_;
    std::vector<sl_string> labels_;
    std::vector<Sample> colors_;
    std::vector<geo::Hit> first_;
    std::vector<DeepestMiss> misses_;
};

} // namespace trace
