// SPDX-License-Identifier: Apache-2.0
#include "tracer/shading_reuse.h"

#include "tracer/light_choice.h"
#include "tracer/lights.h"
#include "tracer/pixel_trace.h"
#include "tracer/ray_levels.h"

#include <algorithm>
#include <cmath>

namespace trace {

namespace {

constexpr std::uint32_t none = geo::no_id;

// Hits of one cell may differ in depth by what a surface that leans this much (76 degrees) does.
constexpr float steepest = 4;

// In the values that are shown, 0..1. A shade that is off by `noise` shows as that much at
// worst, a curved one by a ninth of how far it is off the plane of its neighbours.
constexpr float noise = 0.004f;
constexpr float bend = 0.036f;
constexpr float second_noise = 0.010f;
// The parts of a split cell, off the plane through them.
constexpr float part_noise = 0.016f;
// A cell of fewer samples is not worth being split.
constexpr std::uint32_t least_to_split = 9;

constexpr std::uint64_t bit(sl_variable id) {
    return 1ULL << id;
}

float wanted_number(const rib::Param* p, float fallback) {
    return p == nullptr         ? fallback
           : !p->ints.empty()   ? static_cast<float>(p->ints[0])
           : !p->floats.empty() ? p->floats[0]
                                : fallback;
}

bool is_wanted(const rib::Options& options) {
    const auto it = options.user.find("render:reuse_shading");
    return wanted_number(it != options.user.end() ? &it->second : nullptr, 0) != 0;
}

// Asking the neighbours costs more than a shader that computes nothing.
bool is_worth_it(const ShadingClass& c) {
    const sl_object& surface = c.surface->object();
    constexpr std::uint64_t free =
        bit(SL_VAR_Cs) | bit(SL_VAR_Os) | bit(SL_VAR_Ci) | bit(SL_VAR_Oi);
    return c.displacement != nullptr || c.atmosphere != nullptr || (surface.needed & ~free) != 0 ||
           (surface.facts & (SL_FACT_lights | SL_FACT_textures | SL_FACT_traces)) != 0;
}

std::uint32_t facts_of(const ShadingClass& c) {
    std::uint32_t facts = 0;
    for (const Stage stage : {Stage::Displacement, Stage::Surface, Stage::Atmosphere}) {
        facts |= c.shader(stage) != nullptr ? c.shader(stage)->object().facts : 0;
    }
    return facts;
}

bool reads_time(const ShadingClass& c) {
    return (c.surface->object().needed & (bit(SL_VAR_time) | bit(SL_VAR_dtime))) != 0;
}

// What they give, or their shadows, is drawn at random: places on areas, discs of distant lights,
// some of many lights.
bool has_noisy_lights(const ShadingClass& c, const FrameContext& frame) {
    const auto is_noisy = [&](rib::LightId id) {
        const LightInfo& light = (*frame.lights)[id];
        return light.area != nullptr || light.from_infinity || !light.reusable;
    };
    return std::ranges::any_of(c.lights.directional, is_noisy) ||
           std::ranges::any_of(c.lights.ambient, is_noisy) ||
           c.lights.directional.size() > light_choice_options(frame.scene.options).all_up_to;
}

} // namespace

ShadingReuse::ShadingReuse(const FrameContext& frame, const Camera& camera, const Sampler& sampler,
                           const ShadingClasses& classes, HitShader& shader, ThreadState& thread)
    : frame_(frame), camera_(camera), shader_(shader), thread_(thread),
      per_pixel_(sampler.per_pixel()),
      gain_(frame.scene.options.gain > 0 ? frame.scene.options.gain : 1),
      power_(frame.scene.options.gamma > 0 ? 1 / frame.scene.options.gamma : 1) {
    if (per_pixel_ < 2 || !is_wanted(frame.scene.options)) {
        return;
    }
    const SamplerSettings& s = sampler.settings();
    strata_.by_lens = s.wants_lens;
    strata_.by_time = s.shutter_close > s.shutter_open;
    strata_.open = s.shutter_open;
    strata_.per_second = strata_.by_time ? 4 / (s.shutter_close - s.shutter_open) : 0;
    const std::vector<rib::Attributes>& attributes = frame.scene.attributes;
    for (std::uint32_t i = 0; i < attributes.size(); ++i) {
        policies_.push_back(policy_of(attributes[i], classes.facts(i), classes));
        is_on_ |= policies_.back().level != no_reuse;
    }
}

ShadingReuse::Policy ShadingReuse::policy_of(const rib::Attributes& attributes,
                                             const AttributeFacts& facts,
                                             const ShadingClasses& classes) const {
    const ShadingClass& c = classes[facts.shading_class];
    Policy policy;
    if (wanted_number(attributes.find("render:use_shadingrate"), 1) == 0 || !is_worth_it(c) ||
        (facts_of(c) & SL_FACT_random) != 0) {
        return policy;
    }
    const int level = static_cast<int>(std::floor(std::log2(facts.spacing_px) + 1e-3f));
    const int clamped = std::min(level, max_level);
    if (clamped < min_level ||
        std::ldexp(static_cast<float>(per_pixel_), 2 * clamped) < 2) { // one sample a cell
        return policy;
    }
    policy.level = clamped;
    policy.is_noisy = (facts_of(c) & SL_FACT_traces) != 0 || has_noisy_lights(c, frame_);
    policy.by_time = strata_.by_time && reads_time(c);
    return policy;
}

void ShadingReuse::begin(const PixelRange& tiles) {
    tiles_ = tiles;
    cells_.clear();
    results_.clear();
    results_extra_.clear();
    first_new_ = 0;
    is_first_pass_ = true;
    last_hit_ = {};
    for (std::vector<std::uint32_t>& level : heads_) {
        level.clear();
    }
}

// --- cells

std::uint32_t* ShadingReuse::head(int level, std::int32_t x, std::int32_t y) {
    const auto scaled = [level](std::int32_t px) {
        return level >= 0 ? px >> level : px * (1 << -level);
    };
    const std::int32_t x0 = scaled(tiles_.x0), y0 = scaled(tiles_.y0);
    const std::int32_t width = scaled(tiles_.x1 - 1) + (level < 0 ? 1 << -level : 1) - x0;
    const std::int32_t height = scaled(tiles_.y1 - 1) + (level < 0 ? 1 << -level : 1) - y0;
    if (x < x0 || y < y0 || x >= x0 + width || y >= y0 + height) {
        return nullptr;
    }
    std::vector<std::uint32_t>& heads = heads_[static_cast<std::size_t>(level - min_level)];
    if (heads.empty()) {
        heads.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), none);
    }
    return &heads[static_cast<std::size_t>(y - y0) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x - x0)];
}

// Quarters of the shutter and of the lens; 0 where it makes no difference.
std::uint8_t ShadingReuse::stratum(std::uint32_t sample, float t, const Policy& policy) const {
    unsigned out = 0;
    if (policy.by_time) {
        const float quarter = (block_->time[sample] - strata_.open) * strata_.per_second;
        out = 1 + static_cast<unsigned>(std::clamp(quarter, 0.0f, 3.0f));
    }
    if (strata_.by_lens && camera_.blur_px(t) > 0.5f) {
        out |=
            8U | (block_->lens_x[sample] < 0 ? 16U : 0U) | (block_->lens_y[sample] < 0 ? 32U : 0U);
    }
    return static_cast<std::uint8_t>(out);
}

ShadingReuse::Place ShadingReuse::place_of(std::uint32_t sample) const {
    const std::int32_t x = block_->px[sample], y = block_->py[sample];
    return {static_cast<float>(x - tile_floor(x)) + block_->x[sample],
            static_cast<float>(y - tile_floor(y)) + block_->y[sample]};
}

std::uint32_t ShadingReuse::attributes_of(const geo::Hit& hit) {
    if (hit.shape != last_hit_.shape || hit.instance != last_hit_.instance) {
        last_hit_ = hit;
        last_attributes_ = frame_.world->binding(hit).attributes;
    }
    return last_attributes_;
}

std::uint32_t ShadingReuse::find_cell(const Key& key, float t) {
    for (std::uint32_t c = *head(key.level, key.x, key.y); c != none; c = cells_[c].next) {
        if (cells_[c].key == key && std::fabs(cells_[c].t - t) <= cells_[c].depth_step) {
            return c;
        }
    }
    return none;
}

std::uint32_t ShadingReuse::new_cell(const Key& key, float t) {
    const auto index = static_cast<std::uint32_t>(cells_.size());
    Cell& cell = cells_.emplace_back();
    cell.key = key;
    cell.t = t;
    cell.depth_step = steepest * camera_.footprint(t, std::ldexp(1.0f, key.level));
    std::uint32_t* first = head(key.level, key.x, key.y);
    cell.next = *first;
    *first = index;
    return index;
}

namespace {

std::int32_t cell_index(int level, std::int32_t px, float inside) {
    if (level >= 0) {
        return px >> level;
    }
    const std::int32_t n = 1 << -level;
    return px * n + static_cast<std::int32_t>(inside * static_cast<float>(n));
}

} // namespace

// none: the hit is shaded by itself.
std::uint32_t ShadingReuse::cell_of(std::uint32_t hit) {
    Key key;
    key.attributes = attributes_of(hits_[hit]);
    const Policy& policy = policies_[key.attributes];
    if (policy.level == no_reuse) {
        return none;
    }
    const std::uint32_t sample = sample_of(hit);
    const float t = t_of(hit);
    key.shape = hits_[hit].shape, key.instance = hits_[hit].instance;
    key.layer = rays_.layer;
    key.medium = rays_.media.empty() ? MediumId{0} : rays_.media[hit];
    key.stratum = stratum(sample, t, policy);
    const auto set_level = [&](int level) {
        key.level = static_cast<std::int8_t>(level);
        key.x = cell_index(level, block_->px[sample], block_->x[sample]);
        key.y = cell_index(level, block_->py[sample], block_->y[sample]);
    };
    set_level(policy.level);
    std::uint32_t found = find_cell(key, t);
    if (found == none && !is_first_pass_ && policy.level > 0) {
        set_level(0); // not all samples of larger cells are here
        found = find_cell(key, t);
    }
    while (found != none && cells_[found].state == State::Split) {
        set_level(key.level - 1);
        found = find_cell(key, t);
        if (found == none) {
            return none;
        }
    }
    return found != none ? found : new_cell(key, t);
}

void ShadingReuse::sort_into_cells() {
    cell_of_hit_.assign(hits_.size(), none);
    result_of_hit_.assign(hits_.size(), none);
    for (std::uint32_t i = 0; i < hits_.size(); ++i) {
        if (!hits_[i].valid()) { // a volume may show where nothing is met
            result_of_hit_[i] = has_media_ ? request(i) : none;
            continue;
        }
        cell_of_hit_[i] = cell_of(i);
        if (cell_of_hit_[i] == none) {
            result_of_hit_[i] = request(i);
        } else if (cell_of_hit_[i] >= first_new_) {
            add_member(cells_[cell_of_hit_[i]], i);
        }
    }
}

void ShadingReuse::add_member(Cell& cell, std::uint32_t hit) {
    const Place p = place_of(sample_of(hit));
    cell.sum_x += p.x;
    cell.sum_y += p.y;
    ++cell.count;
}

// --- shading

std::uint32_t ShadingReuse::request(std::uint32_t hit) {
    asked_hits_.push_back(hits_[hit]);
    asked_rays_.push_back(sample_of(hit));
    asked_t_.push_back(t_of(hit));
    if (!rays_.media.empty()) {
        asked_media_.push_back(rays_.media[hit]);
    }
    if (!rays_.since.empty()) {
        asked_since_.push_back(rays_.since[hit]);
    }
    return static_cast<std::uint32_t>(results_.size() + asked_hits_.size() - 1);
}

void ShadingReuse::shade_requests() {
    const std::size_t first = results_.size(), count = asked_hits_.size();
    if (count == 0) {
        return;
    }
    results_.resize(first + count);
    results_extra_.resize((first + count) * num_extra_, 0.0f);
    ShadingRays rays = rays_;
    rays.ray = asked_rays_;
    rays.t = asked_t_;
    rays.media = asked_media_;
    rays.since = asked_since_;
    shader_.shade(rays, asked_hits_, std::span(results_).subspan(first),
                  std::span(results_extra_).subspan(first * num_extra_));
    thread_.counters.add(Counter::reuse_shaded, count);
    asked_hits_.clear();
    asked_rays_.clear();
    asked_t_.clear();
    asked_media_.clear();
    asked_since_.clear();
}

// The member nearest to the middle of all; the first of equals.
void ShadingReuse::choose_samples(std::uint32_t first) {
    for (std::uint32_t i = 0; i < hits_.size(); ++i) {
        if (cell_of_hit_[i] == none || cell_of_hit_[i] < first) {
            continue;
        }
        Cell& cell = cells_[cell_of_hit_[i]];
        const Place p = place_of(sample_of(i));
        const auto n = static_cast<float>(cell.count);
        const float dx = p.x - cell.sum_x / n, dy = p.y - cell.sum_y / n;
        const float distance = dx * dx + dy * dy;
        if (cell.shaded == none || distance < cell.distance) {
            cell.shaded = i;
            cell.distance = distance;
            cell.at_x = p.x;
            cell.at_y = p.y;
        }
    }
}

void ShadingReuse::shade_samples(std::uint32_t first) {
    for (std::uint32_t c = first; c < cells_.size(); ++c) {
        std::uint32_t& result = result_of_hit_[cells_[c].shaded];
        result = result != none ? result : request(cells_[c].shaded);
        cells_[c].result = result;
    }
    shade_requests();
    thread_.counters.add(Counter::reuse_cells, cells_.size() - first);
}

// --- how good it is

ShadingReuse::Values ShadingReuse::values(std::uint32_t result) const {
    const Sample& s = results_[result];
    return {s.color[0], s.color[1], s.color[2], s.opacity[0], s.opacity[1], s.opacity[2]};
}

// What one unit of the picture is there: exposure makes dark places brighter; beyond white it is
// the proportion that counts.
float ShadingReuse::tolerance(const Values& shown) const {
    const float v = gain_ * std::max({shown[0], shown[1], shown[2], 0.0f});
    if (v > 1) {
        return v / gain_;
    }
    return power_ == 1 ? 1 / gain_ : std::pow(std::max(v, 0.02f), 1 - power_) / (power_ * gain_);
}

ShadingReuse::Cell* ShadingReuse::neighbour(const Cell& cell, int dx, int dy) {
    const int level = cell.key.level, x = cell.key.x + dx, y = cell.key.y + dy;
    const auto tile = [level](int at) {
        return level >= 0 ? (at * (1 << level)) >> 4 : at >> (4 - level);
    };
    static_assert(tile_px == 16);
    if (tile(x) != tile(cell.key.x) || tile(y) != tile(cell.key.y)) {
        return nullptr;
    }
    const std::uint32_t* first = head(level, x, y);
    Cell* best = nullptr;
    float nearest = 2 * cell.depth_step;
    for (std::uint32_t c = first != nullptr ? *first : none; c != none; c = cells_[c].next) {
        Cell& other = cells_[c];
        const float step = std::fabs(other.t - cell.t);
        if (other.key.attributes == cell.key.attributes && other.key.layer == cell.key.layer &&
            other.key.stratum == cell.key.stratum && step <= nearest &&
            (is_first_pass_ || c < first_new_)) {
            best = &other;
            nearest = step;
        }
    }
    return best;
}

namespace {

// Least squares: value = c + gx x + gy y over a few points.
struct PlaneFit {
    float n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;

    void add(float px, float py) {
        n += 1, x += px, y += py, xx += px * px, xy += px * py, yy += py * py;
    }
    // Covariances, times n.
    [[nodiscard]] float cxx() const { return xx - x * x / n; }
    [[nodiscard]] float cxy() const { return xy - x * y / n; }
    [[nodiscard]] float cyy() const { return yy - y * y / n; }
    [[nodiscard]] float det() const { return cxx() * cyy() - cxy() * cxy(); }
    [[nodiscard]] bool is_plane() const {
        return n >= 3 && det() > 0.05f * (cxx() + cyy()) * (cxx() + cyy());
    }
};

} // namespace

ShadingReuse::Near ShadingReuse::near(const Cell& cell, const Cell& other) const {
    const Values own = values(cell.result);
    Near n{other.at_x - cell.at_x, other.at_y - cell.at_y, values(other.result)};
    for (std::size_t k = 0; k < num_values; ++k) {
        n.difference[k] -= own[k];
    }
    return n;
}

// Sets the slopes of the cell; none where the places do not span a plane.
ShadingReuse::Misfit ShadingReuse::fit_plane(Cell& cell, std::span<const Near> near) const {
    PlaneFit fit;
    for (const Near& n : near) {
        fit.add(n.x, n.y);
    }
    cell.has_plane = fit.is_plane();
    Misfit out;
    for (std::size_t k = 0; k < num_values && cell.has_plane; ++k) {
        float v = 0, xv = 0, yv = 0;
        for (const Near& n : near) {
            v += n.difference[k];
            xv += n.difference[k] * n.x;
            yv += n.difference[k] * n.y;
        }
        xv -= fit.x * v / fit.n;
        yv -= fit.y * v / fit.n;
        const float gx = (xv * fit.cyy() - yv * fit.cxy()) / fit.det();
        const float gy = (yv * fit.cxx() - xv * fit.cxy()) / fit.det();
        const float c = (v - gx * fit.x - gy * fit.y) / fit.n;
        cell.by_x[k] = gx;
        cell.by_y[k] = gy;
        out.own = std::max(out.own, std::fabs(c));
        for (const Near& n : near) {
            out.others = std::max(out.others, std::fabs(n.difference[k] - c - gx * n.x - gy * n.y));
        }
    }
    return out;
}

// Compares a cell with the plane through its neighbours.
void ShadingReuse::judge(Cell& cell) {
    std::array<Near, 8> around{};
    std::size_t count = 0;
    for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
            const Cell* other = dx != 0 || dy != 0 ? neighbour(cell, dx, dy) : nullptr;
            if (other != nullptr) {
                around[count++] = near(cell, *other);
            }
        }
    }
    const Misfit off = fit_plane(cell, std::span(around).first(count));
    const float unit = tolerance(values(cell.result));
    if (!(off.own <= bend * unit)) { // NaN, too
        cell.state = State::Each;
    } else if (!cell.has_plane || off.own > noise * unit || off.others > 3 * noise * unit) {
        cell.state = State::Doubtful;
    }
}

void ShadingReuse::judge_cells() {
    for (std::uint32_t c = first_new_; c < cells_.size(); ++c) {
        judge(cells_[c]);
    }
}

// Of doubtful cells the member farthest from the one that was shaded.
void ShadingReuse::choose_seconds() {
    for (std::uint32_t i = 0; i < hits_.size(); ++i) {
        if (cell_of_hit_[i] == none || cell_of_hit_[i] < first_new_) {
            continue;
        }
        Cell& cell = cells_[cell_of_hit_[i]];
        if (cell.state != State::Doubtful || i == cell.shaded) {
            continue;
        }
        const Place p = place_of(sample_of(i));
        const float dx = p.x - cell.at_x, dy = p.y - cell.at_y;
        const float distance = dx * dx + dy * dy;
        if (cell.second == none || distance > cell.distance) {
            cell.second = i;
            cell.distance = distance;
        }
    }
    for (std::uint32_t c = first_new_; c < cells_.size(); ++c) {
        Cell& cell = cells_[c];
        if (cell.state == State::Doubtful && cell.second != none) {
            result_of_hit_[cell.second] = request(cell.second);
        } else if (cell.state == State::Doubtful) {
            cell.state = State::Each; // later samples of a lonely one
        }
    }
}

void ShadingReuse::judge_seconds() {
    for (std::uint32_t c = first_new_; c < cells_.size(); ++c) {
        Cell& cell = cells_[c];
        if (cell.state != State::Doubtful) {
            continue;
        }
        const Values seen = values(result_of_hit_[cell.second]);
        Sample expected;
        extrapolate(cell, place_of(sample_of(cell.second)), expected);
        const Values planned = {expected.color[0],   expected.color[1],   expected.color[2],
                                expected.opacity[0], expected.opacity[1], expected.opacity[2]};
        float off = 0;
        for (std::size_t k = 0; k < num_values; ++k) {
            off = std::max(off, std::fabs(seen[k] - planned[k]));
        }
        cell.state = off <= second_noise * tolerance(seen) ? State::Plane : State::Each;
    }
}

// Where shading differs at random, neighbours that agree may do so by chance.
void ShadingReuse::spread_doubt() {
    constexpr int reach = 3;
    for (std::uint32_t c = first_new_; c < cells_.size() && is_first_pass_; ++c) {
        const Cell cell = cells_[c];
        if (cell.state != State::Each || !policies_[cell.key.attributes].is_noisy || cell.is_told) {
            continue;
        }
        for (int dy = -reach; dy <= reach; ++dy) {
            for (int dx = -reach; dx <= reach; ++dx) {
                Cell* other = neighbour(cell, dx, dy);
                if (other != nullptr && other->state != State::Each) {
                    other->state = State::Each;
                    other->is_told = true; // goes no farther
                }
            }
        }
    }
}

// --- parts of cells

bool ShadingReuse::mark_splits(std::uint32_t first) {
    bool any = false;
    for (std::uint32_t c = first; c < cells_.size(); ++c) {
        Cell& cell = cells_[c];
        if (cell.state == State::Each && cell.count >= least_to_split &&
            cell.key.level > min_level && !policies_[cell.key.attributes].is_noisy) {
            cell.state = State::Split;
            any = true;
        }
    }
    return any;
}

void ShadingReuse::sort_into_children(std::uint32_t first) {
    const auto first_child = static_cast<std::uint32_t>(cells_.size());
    for (std::uint32_t i = 0; i < hits_.size(); ++i) {
        const std::uint32_t parent = cell_of_hit_[i];
        if (parent == none || parent < first || parent >= first_child ||
            cells_[parent].state != State::Split) {
            continue;
        }
        Key key = cells_[parent].key;
        const std::uint32_t sample = sample_of(i);
        --key.level;
        key.x = cell_index(key.level, block_->px[sample], block_->x[sample]);
        key.y = cell_index(key.level, block_->py[sample], block_->y[sample]);
        std::uint32_t child = find_cell(key, t_of(i));
        child = child != none ? child : new_cell(key, t_of(i));
        cells_[child].parent = parent;
        cell_of_hit_[i] = child;
        add_member(cells_[child], i);
    }
}

// Children lie side by side behind first; those of one parent must agree with each other and with
// what was shaded of the parent.
void ShadingReuse::judge_children(std::uint32_t first) {
    for (std::uint32_t c = first; c < cells_.size(); ++c) {
        Cell& cell = cells_[c];
        std::array<Near, 5> family{};
        std::size_t count = 0;
        family[count++] = near(cell, cells_[cell.parent]);
        const int x = cell.key.x & ~1, y = cell.key.y & ~1;
        for (int part = 0; part < 4; ++part) {
            const std::uint32_t* at = head(cell.key.level, x + (part & 1), y + (part >> 1));
            for (std::uint32_t o = at != nullptr ? *at : none; o != none; o = cells_[o].next) {
                if (cells_[o].parent == cell.parent && count < family.size()) {
                    family[count++] = near(cell, cells_[o]);
                }
            }
        }
        const Misfit off = fit_plane(cell, std::span(family).first(count));
        const bool agrees = cell.has_plane && std::max(off.own, off.others) <=
                                                  part_noise * tolerance(values(cell.result));
        cell.state = agrees ? State::Plane : State::Each;
    }
}

// Where one shade does not do for a cell, four may.
void ShadingReuse::split_cells() {
    for (std::uint32_t first = first_new_; is_first_pass_ && mark_splits(first);) {
        const auto first_child = static_cast<std::uint32_t>(cells_.size());
        sort_into_children(first);
        choose_samples(first_child);
        shade_samples(first_child);
        judge_children(first_child);
        first = first_child;
    }
}

void ShadingReuse::shade_rest() {
    for (std::uint32_t i = 0; i < hits_.size(); ++i) {
        if (cell_of_hit_[i] != none && cells_[cell_of_hit_[i]].state == State::Each &&
            result_of_hit_[i] == none) {
            result_of_hit_[i] = request(i);
        }
    }
    shade_requests();
}

// --- results

void ShadingReuse::extrapolate(const Cell& cell, const Place& to, Sample& out) const {
    const Sample& at = results_[cell.result];
    const float dx = to.x - cell.at_x, dy = to.y - cell.at_y;
    for (std::size_t k = 0; k < 3; ++k) {
        const float color = at.color[k] + dx * cell.by_x[k] + dy * cell.by_y[k];
        out.color[k] = color < 0 && at.color[k] >= 0 ? 0 : color;
        out.opacity[k] =
            std::clamp(at.opacity[k] + dx * cell.by_x[k + 3] + dy * cell.by_y[k + 3], 0.0f, 1.0f);
    }
}

void ShadingReuse::give_results(std::span<Sample> out, std::span<float> out_extra) {
    std::uint64_t num_reused = 0;
    for (std::uint32_t i = 0; i < hits_.size(); ++i) {
        if (!hits_[i].valid() && result_of_hit_[i] == none) {
            continue;
        }
        std::uint32_t result = result_of_hit_[i];
        if (result != none) {
            std::copy_n(results_[result].color, 3, out[i].color);
            std::copy_n(results_[result].opacity, 3, out[i].opacity);
        } else {
            const Cell& cell = cells_[cell_of_hit_[i]];
            const std::uint32_t sample = sample_of(i);
            extrapolate(cell, place_of(sample), out[i]);
            result = cell.result;
            ++num_reused;
            if (thread_.trace != nullptr) {
                thread_.trace->reused(
                    sample, cell.at_x + static_cast<float>(tile_floor(block_->px[sample])),
                    cell.at_y + static_cast<float>(tile_floor(block_->py[sample])), out[i]);
            }
        }
        std::copy_n(results_extra_.begin() + static_cast<std::ptrdiff_t>(result * num_extra_),
                    num_extra_, out_extra.begin() + static_cast<std::ptrdiff_t>(i * num_extra_));
    }
    thread_.counters.add(Counter::reuse_spared, num_reused);
}

void ShadingReuse::shade(const ShadingRays& rays, std::span<const geo::Hit> hits,
                         std::span<Sample> out, std::span<float> out_extra) {
    rays_ = rays;
    has_media_ = thread_.levels != nullptr && thread_.levels->media().any();
    hits_ = hits;
    num_extra_ = hits.empty() ? 0 : out_extra.size() / hits.size();
    first_new_ = static_cast<std::uint32_t>(cells_.size());
    sort_into_cells();
    choose_samples(first_new_);
    shade_samples(first_new_);
    judge_cells();
    choose_seconds();
    shade_requests();
    judge_seconds();
    spread_doubt();
    split_cells();
    shade_rest();
    give_results(out, out_extra);
}

} // namespace trace
