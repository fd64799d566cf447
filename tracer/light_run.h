// SPDX-License-Identifier: Apache-2.0
// One light's working memory on one thread: its shader, run for the points of one packet, sample by
// sample, and the light that gets through to them. What it found is kept until other points are
// lit, so that diffuse() and specular() share it. The light vector is negated on the way out:
// shaders being lit see L from the point towards the light, its length kept.
#pragma once

#include "geometry/shadow_segment.h"
#include "runtime/batch.h"
#include "tracer/execution.h"
#include "tracer/light_choice.h"
#include "tracer/lights.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace trace {

// One sample of a light at the points of a packet; planes of SL_LANES_MAX.
struct LightSample {
    static constexpr std::size_t lanes = SL_LANES_MAX;
    alignas(32) float L[3 * lanes];
    alignas(32) float Cl[3 * lanes]; // its share of the light: the sum over samples is all
    alignas(32) float Ol[3 * lanes];
    alignas(32) float nondiffuse[lanes], nonspecular[lanes];
    alignas(32) float passes[3 * lanes]; // of the light, what nothing keeps off
    geo::Hit on[lanes];                  // area lights: where on the light
    std::uint32_t known = 0;             // lanes that hold a result
    std::uint32_t lit = 0;               // of them, those illuminate or solar was executed for
    std::uint32_t traced = 0;            // lanes that `passes` is known for
};

// Where shadow rays of a packet's points start. Points that lie on the hit start outside its
// rounding error; points a shader made up (a march through a volume) lie on nothing.
class ShadowOrigins {
public:
    // Of a point of the packet at `first` of the asker's batch; null: it starts as it is.
    const geo::SpawnPoint* at(const Execution& asker, std::uint32_t first, std::uint32_t lane,
                              const base::V3f& P);

private:
    const Execution* asker_ = nullptr;
    std::uint64_t serial_ = 0;
    std::uint32_t first_ = 0, known_ = 0;
    geo::SpawnPoint spawn_[SL_LANES_MAX];
};

// The shading point P of a batch as a hit of a surface; null if P is another point.
[[nodiscard]] const geo::Hit* hit_at(const Execution& asker, std::size_t point, const base::V3f& P);

// What random numbers of a point are made from.
[[nodiscard]] std::uint32_t seed_of(const Execution& execution, std::size_t point);

class LightRun {
public:
    // Prepares for a batch of `asker`; what was found for other batches is forgotten.
    void attach(Execution& asker, const LightInfo& info, rib::LightId id);
    // Runs sample query.sample for the points of a packet (query.N may be null) unless that is
    // known. Returns the lanes of query.mask whose illuminate or solar was executed; ambient
    // lights: all of them.
    std::uint32_t illuminate(const sl_light_query& query);
    // Traces shadow rays of a sample for these lanes unless they are known.
    void trace_shadows(std::int32_t sample, std::uint32_t mask, ShadowOrigins& origins);
    [[nodiscard]] bool wants(sl_string category);
    // Samples of the light at the points last lit.
    [[nodiscard]] std::int32_t num_samples() const;
    [[nodiscard]] const LightSample& sample(std::int32_t index) const {
        return samples_[static_cast<std::size_t>(index)];
    }
    // The batch holds the values of this sample for these points: for messages.
    void recall(const sl_light_query& query);

    [[nodiscard]] const LightInfo& info() const { return *info_; }
    [[nodiscard]] rt::ShadeBatch& batch() { return batch_; }
    // The service `solar_direction` of the run at work.
    void choose_solar_direction(const SolarQuery& query, std::uint32_t lanes);

private:
    void begin();
    void move_to(const sl_light_query& query);
    LightSample& sample_of(std::int32_t index);
    [[nodiscard]] bool is_known(const sl_light_query& query, const LightSample& sample) const;
    void run_lanes(const sl_light_query& query, std::uint32_t mask, LightSample& sample);
    void run_shader(std::uint32_t num_points);
    void collect(std::uint32_t mask, LightSample& sample);
    [[nodiscard]] std::uint32_t executed() const;
    void drop_bad();
    void fill_frame(const Space& space);
    void fill_points(std::uint32_t mask, const float* N);
    void fill_place(std::uint32_t mask, LightSample& sample);
    void fill_differences(std::uint32_t mask);
    void fill_seeds_and_time();
    void reset_results();
    void send(const sl_light_query& query, std::uint32_t mask);
    void send_value(const sl_light_query& query, std::uint32_t mask, int index,
                    const sl_value& value);
    [[nodiscard]] std::uint32_t alike(const sl_light_query& query, std::uint32_t mask) const;
    [[nodiscard]] float param(int index, std::uint32_t lane);
    [[nodiscard]] float time_of(std::uint32_t lane) const;
    [[nodiscard]] base::V3f point(std::uint32_t lane) const {
        return {Ps_[0][lane], Ps_[1][lane], Ps_[2][lane]};
    }
    [[nodiscard]] geo::ShadowSegment shadow_segment(const LightSample& sample, std::uint32_t lane,
                                                    ShadowOrigins& origins) const;

    Execution* asker_ = nullptr;
    const LightInfo* info_ = nullptr;
    rib::LightId id_ = 0;
    const rt::ShaderInstance* instance_ = nullptr; // of its shader, as it runs now
    std::optional<Execution> execution_;
    rt::ShadeBatch batch_;
    std::uint64_t serial_ = 0;
    std::uint32_t first_ = 0, lanes_ = 0;
    bool sent_ = false;    // the batch's parameters hold what an illuminance sent
    bool spreads_ = false; // solar: this packet's light comes from more than one direction
    float Ps_[3][SL_LANES_MAX] = {};
    float weight_[SL_LANES_MAX] = {};
    std::uint32_t seed_[SL_LANES_MAX] = {}; // of the points, for places on the light
    std::int32_t in_batch_ = -1;            // the sample whose values the batch holds,
    std::uint32_t in_batch_mask_ = 0;       // and for which lanes
    std::vector<LightSample> samples_;
    sl_string category_ = nullptr; // of the last wants(), and its answer
    bool wanted_ = true;
};

// What a thread keeps for its lights.
struct LightScratch {
    std::vector<std::unique_ptr<LightRun>> runs; // by light, made on first use
    ShadowOrigins origins;
    LightChoice choice;
};

// The light, prepared for a batch.
LightRun& attached(Execution& execution, rib::LightId id);

} // namespace trace
