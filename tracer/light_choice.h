// SPDX-License-Identifier: Apache-2.0
// Many lights: each point is lit by some, chosen by what they are likely to give, and those make up
// for the rest. In: a point, the direction it faces, its seed. Out: lights and weights whose
// expectation is the sum over all lights, whatever the shaders do.
//
// What to expect is learned from the light shaders themselves: space is divided into cells, finer
// near lights, and every light runs for a few probes of a cell when the first point of it is shaded
// ("light cell"). No light's probability falls below a floor: one that shone on none of the probes
// is not missed. A point's choice depends on the point alone, never on who shares its packet.
// Cells are shared by all threads; what is in one does not depend on who made it.
#pragma once

#include "tracer/execution.h"

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <vector>

namespace trace {

class LightProber;
struct LightList;

struct LightChoiceOptions {
    std::uint32_t samples = 32;   // Option "lights" "samples": lights for a point; 0: all
    std::uint32_t all_up_to = 64; // Option "lights" "allupto": lists this long are not chosen from
};
[[nodiscard]] LightChoiceOptions light_choice_options(const rib::Options& options);

// The lights of a list as one cell and one facing expect them.
struct LightTable {
    // Positions in the list, in an order of places, with the sum of probabilities up to each.
    struct Item {
        std::uint32_t index;
        float up_to;
        float probability;
    };
    std::vector<Item> certain, others;
    // Appends what a point gets: systematic sampling [Madow49] with the start u of [0,1).
    struct Pick {
        std::uint32_t index;
        float weight;
    };
    void pick(float u, std::vector<Pick>& out) const;
};

class LightCells {
public:
    LightCells(const FrameContext& frame, LightChoiceOptions options);
    ~LightCells();

    [[nodiscard]] const LightChoiceOptions& options() const { return options_; }
    // Lists this long are chosen from.
    [[nodiscard]] bool is_many(const LightList& list) const;
    // axis: where the point faces, null: everywhere.
    [[nodiscard]] const LightTable& table(LightProber& prober, const LightList& list,
                                          const base::V3f& P, const base::V3f* axis) const;

private:
    struct Key {
        const LightList* list;
        std::int32_t level, x, y, z;
        std::int32_t facing;
        friend bool operator==(const Key&, const Key&) = default;
    };
    struct KeyHash {
        std::size_t operator()(const Key& key) const;
    };
    [[nodiscard]] Key key_of(const LightList& list, const base::V3f& P,
                             const base::V3f* axis) const;
    [[nodiscard]] std::unique_ptr<LightTable> make(LightProber& prober, const LightList& list,
                                                   const Key& key) const;
    [[nodiscard]] std::vector<double> expected(LightProber& prober, const LightList& list,
                                               const Key& key) const;
    void find_positions(const FrameContext& frame);

    LightChoiceOptions options_;
    base::V3f low_, size_of_all_;      // box of the lights that have a place
    float edge_ = 1;                   // of the finest cells
    std::vector<std::uint64_t> place_; // of each light on a curve through space; by LightId
    mutable std::mutex mutex_;
    mutable std::unordered_map<Key, std::unique_ptr<LightTable>, KeyHash> tables_;
};

// What the points of one packet chose; one per thread, kept while the same points are lit.
class LightChoice {
public:
    struct Chosen {
        std::int32_t index = 0; // position in the list
        std::uint32_t mask = 0;
        float weight[SL_LANES_MAX] = {};
    };
    LightChoice();
    ~LightChoice();
    // Null where all lights are asked.
    [[nodiscard]] const std::vector<Chosen>* choose(const Execution& execution,
                                                    const sl_light_query& query);

private:
    void choose_lane(const Execution& execution, const sl_light_query& query, std::uint32_t lane);
    [[nodiscard]] bool is_known(const Execution& execution, const sl_light_query& query) const;

    std::unique_ptr<LightProber> prober_;
    const Execution* execution_ = nullptr;
    std::uint64_t serial_ = 0;
    std::uint32_t first_ = 0, mask_ = 0;
    float P_[3 * SL_LANES_MAX] = {}, axis_[3 * SL_LANES_MAX] = {};
    bool has_axis_ = false;
    std::vector<LightTable::Pick> picks_;
    struct Pair {
        std::uint32_t index, lane;
        float weight;
    };
    std::vector<Pair> pairs_;
    std::vector<Chosen> chosen_;
};

} // namespace trace
