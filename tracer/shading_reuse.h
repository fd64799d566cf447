// SPDX-License-Identifier: Apache-2.0
// Shading about once per ShadingRate area of a surface, however many samples see it. Stands in
// front of HitShader: the same hits in, the same results out.
//
// Hits of one primitive, layer, side of a depth step and stratum of time and lens that lie in one
// cell of the raster of the whole frame share a shade: that of the sample nearest to their centre;
// the others get it extrapolated by the gradient over the neighbouring cells. Where neighbours say
// that shading is no plane there, a second sample is shaded; where that differs from what was
// expected, all are. Cells and neighbours never cross tiles of the frame, so that no bucket, crop
// window or thread has an influence. Rules and reasons: docs/sampling.md.
#pragma once

#include "tracer/camera.h"
#include "tracer/film.h"
#include "tracer/hit_shader.h"
#include "tracer/sampler.h"
#include "tracer/shading_classes.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace trace {

// Where the samples of a cell differ by more than their place.
struct CellStrata {
    bool by_time = false, by_lens = false;
    float open = 0, per_second = 0; // strata of time
};

class ShadingReuse {
public:
    ShadingReuse(const FrameContext& frame, const Camera& camera, const Sampler& sampler,
                 const ShadingClasses& classes, HitShader& shader, ThreadState& thread);

    // False: nothing in the scene is worth it, or allowed.
    [[nodiscard]] bool is_on() const { return is_on_; }
    // A new bucket: samples of whole tiles, or all there is of them.
    void begin(const PixelRange& tiles);
    // From now on more samples of some pixels. They use the cells there are; new ones stay inside
    // their pixel.
    void begin_more() { is_first_pass_ = false; }
    // Rays are numbered as the samples of this block from here on.
    void begin_pass(const SampleBlock& block) { block_ = &block; }
    // As HitShader's, for camera rays.
    void shade(const ShadingRays& rays, std::span<const geo::Hit> hits, std::span<Sample> out,
               std::span<float> out_extra);

private:
    static constexpr std::size_t num_values = 6; // colour and opacity
    using Values = std::array<float, num_values>;
    static constexpr int min_level = -2, max_level = 4;
    static constexpr int no_reuse = -100;

    // By attribute state.
    struct Policy {
        int level = no_reuse;  // cells are 2^level pixels wide
        bool is_noisy = false; // shading may differ at random: needs more evidence
        bool by_time = false;
    };
    enum class State : std::uint8_t { Plane, Doubtful, Each, Split };
    // Hits of equal keys, and depths that one surface may have, are neighbours.
    struct Key {
        std::int32_t x = 0, y = 0; // in cells of the level, from the frame's corner
        std::uint32_t shape = 0, instance = 0, attributes = 0, layer = 0;
        MediumId medium = 0; // before them
        std::int8_t level = 0;
        std::uint8_t stratum = 0;
        friend bool operator==(const Key&, const Key&) = default;
    };
    struct Cell {
        Key key;
        std::uint32_t next = geo::no_id; // at the same place of the raster
        float t = 0;                     // of the first member
        float depth_step = 0;            // how far from it those of the others may be
        State state = State::Plane;
        bool has_plane = false;
        bool is_told = false;              // its state is that of another
        std::uint32_t parent = geo::no_id; // that was split
        std::uint32_t count = 0;
        float sum_x = 0, sum_y = 0;                             // of members, relative to the tiles
        std::uint32_t shaded = geo::no_id, second = geo::no_id; // hits of the call that made it
        float distance = 0;                                     // of the one in work, squared
        float at_x = 0, at_y = 0;                               // where it was shaded
        std::uint32_t result = 0;                               // in results_
        Values by_x{}, by_y{};                                  // gradient, per pixel
    };
    struct Place { // of a sample in its tile, pixels: rounded alike in every bucket
        float x, y;
    };

    [[nodiscard]] Policy policy_of(const rib::Attributes& attributes, const AttributeFacts& facts,
                                   const ShadingClasses& classes) const;
    [[nodiscard]] std::uint32_t* head(int level, std::int32_t x, std::int32_t y);
    [[nodiscard]] std::uint8_t stratum(std::uint32_t sample, float t, const Policy& policy) const;

    // One call of shade(), in this order.
    void sort_into_cells();
    [[nodiscard]] std::uint32_t cell_of(std::uint32_t hit);
    [[nodiscard]] std::uint32_t find_cell(const Key& key, float t);
    [[nodiscard]] std::uint32_t new_cell(const Key& key, float t);
    [[nodiscard]] std::uint32_t attributes_of(const geo::Hit& hit);
    void add_member(Cell& cell, std::uint32_t hit);
    void choose_samples(std::uint32_t first);
    void shade_samples(std::uint32_t first);
    void judge_cells();
    void choose_seconds();
    void judge_seconds();
    void spread_doubt();
    void split_cells();
    [[nodiscard]] bool mark_splits(std::uint32_t first);
    void sort_into_children(std::uint32_t first);
    void judge_children(std::uint32_t first);
    void shade_rest();
    void give_results(std::span<Sample> out, std::span<float> out_extra);

    // Values at places relative to a cell's shaded sample, and what is off the plane through them.
    struct Near {
        float x, y;
        Values difference;
    };
    struct Misfit {
        float own = 0, others = 0;
    };
    [[nodiscard]] Misfit fit_plane(Cell& cell, std::span<const Near> near) const;
    [[nodiscard]] Near near(const Cell& cell, const Cell& other) const;
    void judge(Cell& cell);
    [[nodiscard]] Cell* neighbour(const Cell& cell, int dx, int dy);
    [[nodiscard]] Values values(std::uint32_t result) const;
    [[nodiscard]] float tolerance(const Values& shown) const;
    void extrapolate(const Cell& cell, const Place& to, Sample& out) const;
    [[nodiscard]] std::uint32_t request(std::uint32_t hit);
    void shade_requests();
    [[nodiscard]] std::uint32_t sample_of(std::uint32_t hit) const {
        return rays_.ray.empty() ? hit : rays_.ray[hit];
    }
    [[nodiscard]] float t_of(std::uint32_t hit) const {
        return rays_.t.empty() ? hits_[hit].t : rays_.t[hit];
    }
    [[nodiscard]] Place place_of(std::uint32_t sample) const;

    const FrameContext& frame_;
    const Camera& camera_;
    HitShader& shader_;
    ThreadState& thread_;
    bool is_on_ = false;
    int per_pixel_;
    CellStrata strata_;
    float gain_, power_;
    std::vector<Policy> policies_; // by attribute state

    PixelRange tiles_;
    std::array<std::vector<std::uint32_t>, max_level - min_level + 1> heads_; // by level
    std::vector<Cell> cells_;
    std::uint32_t first_new_ = 0; // cells of this call
    bool is_first_pass_ = true;   // whole tiles
    bool has_media_ = false;      // volumes that rays pass
    std::vector<Sample> results_;
    std::vector<float> results_extra_;
    std::size_t num_extra_ = 0;

    const SampleBlock* block_ = nullptr;
    ShadingRays rays_; // of the call in work, as what follows
    std::span<const geo::Hit> hits_;
    geo::Hit last_hit_; // neighbouring rays mostly meet the same shape
    std::uint32_t last_attributes_ = 0;
    std::vector<std::uint32_t> cell_of_hit_, result_of_hit_;
    std::vector<geo::Hit> asked_hits_;
    std::vector<std::uint32_t> asked_rays_;
    std::vector<float> asked_t_, asked_since_;
    std::vector<MediumId> asked_media_;
};

} // namespace trace
