// SPDX-License-Identifier: Apache-2.0
#include "tracer/indirect_ambient.h"

#include "tracer/asking_point.h"
#include "tracer/execution.h"
#include "tracer/hemisphere_gather.h"
#include "tracer/indirect_light.h"
#include "tracer/shader_set.h"

#include <algorithm>
#include <array>
#include <bit>
#include <memory>
#include <vector>

namespace trace {

namespace {

// From the third diffuse bounce on paths end at random, the darker the surface the earlier.
constexpr int first_roulette = 2;
constexpr float least_survival = 0.05f;
constexpr sl_variable own_variables[] = {SL_VAR_P, SL_VAR_N, SL_VAR_Ng};

class BatchGather {
public:
    BatchGather(Execution& execution, IndirectBatch& out)
        : execution_(execution), light_(*execution.frame.indirect), out_(out),
          diffuse_level_(diffuse_level(execution)) {}
    void run();

private:
    [[nodiscard]] base::V3f triple(sl_variable id, std::uint32_t point) const;
    void fill_geometry();
    [[nodiscard]] DiffusePoint point_of(std::uint32_t point) const;
    [[nodiscard]] base::V3f towards_eye(std::uint32_t point, const base::V3f& P) const;
    void set(std::uint32_t point, const base::Color& c);
    void find_covered();
    void trace();
    // Paths go on with this probability.
    [[nodiscard]] float survival(std::uint32_t point) const;

    Execution& execution_;
    const IndirectLight& light_;
    IndirectBatch& out_;
    int diffuse_level_;
    std::vector<DiffusePoint> points_; // that need rays ...
    std::vector<std::uint32_t> index_; // ... and which they are
    std::vector<float> survival_;
    // What geometry says, for variables the shader has no planes for.
    alignas(64) std::array<std::array<float, 3 * SL_BATCH_MAX>, 3> own_{}; // P, N, Ng
};

void BatchGather::fill_geometry() {
    const BatchSubject& subject = *execution_.subject;
    sl_points planes = {};
    std::uint64_t needed = 0;
    for (std::size_t i = 0; i < std::size(own_variables); ++i) {
        planes.var[own_variables[i]] = own_[i].data();
        needed |= 1ULL << own_variables[i];
    }
    execution_.frame.world->fill(subject.hits, subject.incident, needed, SL_BATCH_MAX, planes,
                                 nullptr, nullptr);
}

// The shader's planes come first: a displacement may have moved them.
base::V3f BatchGather::triple(sl_variable id, std::uint32_t point) const {
    rt::ShadeBatch& batch = *execution_.batch;
    const auto own =
        static_cast<std::size_t>(std::ranges::find(own_variables, id) - std::begin(own_variables));
    const bool is_shaders = batch.has(id) && id != SL_VAR_Ng;
    const float* plane = is_shaders ? batch.plane(id) : own_[own].data();
    const std::size_t stride = is_shaders ? batch.stride() : std::size_t{SL_BATCH_MAX};
    return {plane[point], plane[stride + point], plane[2 * stride + point]};
}

base::V3f BatchGather::towards_eye(std::uint32_t point, const base::V3f& P) const {
    rt::ShadeBatch& batch = *execution_.batch;
    if (batch.has(SL_VAR_I)) {
        return {-batch.plane(SL_VAR_I, 0)[point], -batch.plane(SL_VAR_I, 1)[point],
                -batch.plane(SL_VAR_I, 2)[point]};
    }
    const geo::Incident& rays = execution_.subject->incident;
    return point < rays.dx.size() ? -base::V3f(rays.dx[point], rays.dy[point], rays.dz[point]) : -P;
}

DiffusePoint BatchGather::point_of(std::uint32_t point) const {
    DiffusePoint p;
    p.hit = execution_.subject->hits[point];
    p.P = triple(SL_VAR_P, point);
    const base::V3f eye = towards_eye(point, p.P);
    const auto facing = [&eye](const base::V3f& normal) {
        const base::V3f n = base::normalize(normal);
        return base::dot(n, eye) < 0 ? -n : n;
    };
    p.Ng = facing(triple(SL_VAR_Ng, point));
    p.N = facing(triple(SL_VAR_N, point));
    p.N = base::dot(p.N, p.N) > 0.5f ? p.N : p.Ng;
    p.seed = point_seed(execution_, point) ^ 0x696e6469U;
    p.medium = point_medium(execution_, point);
    p.settings = light_.settings(execution_.frame.world->binding(p.hit).attributes);
    return p;
}

void BatchGather::set(std::uint32_t point, const base::Color& c) {
    out_.is_lit[point] = true;
    out_.light[0][point] = c.r;
    out_.light[1][point] = c.g;
    out_.light[2][point] = c.b;
}

float BatchGather::survival(std::uint32_t point) const {
    if (diffuse_level_ < first_roulette) {
        return 1;
    }
    rt::ShadeBatch& batch = *execution_.batch;
    const rib::Attributes& state =
        execution_.frame.scene.attributes
            [execution_.frame.world->binding(execution_.subject->hits[point]).attributes];
    float most = least_survival;
    for (int k = 0; k < 3; ++k) {
        most = std::max(most, batch.has(SL_VAR_Cs) ? batch.plane(SL_VAR_Cs, k)[point]
                                                   : state.color[static_cast<std::size_t>(k)]);
    }
    return std::min(most, 1.0f);
}

void BatchGather::find_covered() {
    Counters& counters = execution_.thread->counters;
    const bool is_rehearsal = execution_.thread->wanted != nullptr;
    const float stretch = diffuse_level_ > 0 ? IrradianceCache::far_slack
                          : is_rehearsal     ? 1
                                             : IrradianceCache::slack;
    const bool may_go_on = diffuse_level_ < light_.max_bounces();
    for (std::uint32_t i = 0; i < execution_.subject->hits.size(); ++i) {
        const DiffusePoint point = point_of(i);
        if (point.settings.num_rays == 0 || base::dot(point.N, point.N) < 0.5f) {
            continue;
        }
        const auto found =
            point.settings.max_error > 0
                ? light_.cache.lookup({point.P, point.N, point.settings.max_error}, stretch)
                : std::nullopt;
        counters.add(Counter::irradiance_found, found ? 1 : 0);
        set(i, found.value_or(base::Color(0)));
        if (found || !may_go_on) {
            continue;
        }
        const float chance = survival(i);
        if (SampleStream(point.seed ^ 0x726f756cU).next() < chance) {
            points_.push_back(point);
            index_.push_back(i);
            survival_.push_back(chance);
        }
    }
}

// Rays per point differ with the settings: points of equal settings go together, in their order.
void BatchGather::trace() {
    const DiffuseRays::Asker asker{execution_.frame, *execution_.thread, execution_.ray_level,
                                   diffuse_level_};
    std::vector<base::Color> means;
    for (std::size_t begin = 0; begin < points_.size();) {
        const std::uint32_t num_rays =
            diffuse_level_ == 0 ? light_.rays_uncovered(points_[begin].settings) : 1;
        std::size_t end = begin + 1;
        while (end < points_.size() &&
               (diffuse_level_ > 0 || light_.rays_uncovered(points_[end].settings) == num_rays)) {
            ++end;
        }
        means.resize(end - begin);
        HemisphereGather(asker).means({points_.data() + begin, end - begin}, num_rays, means);
        for (std::size_t i = begin; i < end; ++i) {
            set(index_[i], means[i - begin] * (1 / survival_[i]));
        }
        begin = end;
    }
}

void BatchGather::run() {
    fill_geometry();
    find_covered();
    ThreadState& thread = *execution_.thread;
    if (thread.wanted != nullptr && diffuse_level_ == 0) {
        for (const DiffusePoint& point : points_) {
            if (point.settings.max_error > 0) {
                thread.wanted->push_back(point);
            }
        }
        return; // a rehearsal: nobody looks at the colours
    }
    thread.counters.add(Counter::irradiance_traced, points_.size());
    trace();
}

bool is_surface(const Execution& execution) {
    return execution.running.object().type == SL_SHADER_surface && execution.thread != nullptr &&
           execution.subject != nullptr && execution.batch != nullptr &&
           execution.frame.world != nullptr && execution.asked_by == nullptr;
}

} // namespace

std::uint32_t indirect_ambient(Execution& execution, std::uint32_t first, std::uint32_t mask,
                               float* C) {
    if (!is_surface(execution) || execution.frame.indirect == nullptr ||
        !execution.frame.indirect->is_used()) {
        return 0;
    }
    if (!execution.indirect) {
        execution.indirect = std::make_shared<IndirectBatch>();
    }
    IndirectBatch& batch = *execution.indirect;
    if (!batch.is_found) {
        batch.is_found = true;
        BatchGather(execution, batch).run();
    }
    const std::uint32_t lanes = execution.lanes();
    std::uint32_t lit = 0;
    for (std::uint32_t rest = mask; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(rest));
        if (first + lane >= execution.subject->hits.size() || !batch.is_lit[first + lane]) {
            continue;
        }
        lit |= 1U << lane;
        for (std::uint32_t k = 0; k < 3; ++k) {
            C[k * lanes + lane] = batch.light[k][first + lane];
        }
    }
    return lit;
}

} // namespace trace
