// SPDX-License-Identifier: Apache-2.0
#include "tracer/indirect_prepass.h"

#include "runtime/base/parallel.h"
#include "tracer/camera.h"
#include "tracer/hit_shader.h"
#include "tracer/ray_layers.h"
#include "tracer/ray_levels.h"
#include "tracer/sampler.h"

#include <algorithm>
#include <cmath>

namespace trace {

namespace {

// Records reach 20 pixels by default: points nearer than that would be asked in vain at first.
constexpr int coarsest_px = 32, finest_px = 2;
// No record serves less than this: else they would pile up where surfaces meet. With the slack of
// rendering, records on the finest grid leave no gaps between them.
constexpr float least_reach_px = 1.5f;
constexpr std::size_t records_per_item = 4;

} // namespace

struct IndirectPrepass::Worker {
    Worker(const Tools& tools, const VisibilityOptions& visibility)
        : shader(tools.frame, tools.camera, tools.classes, nullptr, thread),
          layers(tools.frame, tools.classes, nullptr, visibility, shader, thread) {
        thread.levels = std::make_unique<RayLevels>(tools.frame, tools.camera, tools.classes,
                                                    visibility, thread);
    }
    ThreadState thread;
    HitShader shader;
    RayLayers layers;
    SampleBlock block;
    std::vector<geo::RayPacket> packets;
    std::vector<Sample> samples;
};

IndirectPrepass::IndirectPrepass(const Tools& tools, IndirectLight& light)
    : tools_(tools), light_(light), pixels_(tools.camera.raster().picture),
      workers_(static_cast<std::size_t>(base::thread_count(tools.num_threads))) {}

IndirectPrepass::~IndirectPrepass() = default;

IndirectPrepass::Worker& IndirectPrepass::worker(int slot) {
    std::unique_ptr<Worker>& w = workers_[static_cast<std::size_t>(slot)];
    if (!w) {
        w = std::make_unique<Worker>(tools_, visibility_options(tools_.frame.scene.options));
    }
    return *w;
}

// Each step doubles the number of points, evenly: a square grid, its middles, and so on.
std::vector<IndirectPrepass::Step> IndirectPrepass::steps() {
    std::vector<Step> all = {{coarsest_px, 0, 0}};
    for (int spacing = coarsest_px; spacing > finest_px; spacing /= 2) {
        const int half = spacing / 2;
        all.push_back({spacing, half, half});
        all.push_back({spacing, half, 0});
        all.push_back({spacing, 0, half});
    }
    return all;
}

// Camera rays through the middles of pixels, shaded as in the picture; ambient() notes what it
// lacks. Colours are thrown away.
void IndirectPrepass::shade_row(const Step& step, int y, Worker& w, WantedPoints& wanted) const {
    SampleBlock& block = w.block;
    block = {};
    const PixelHash hash(y);
    for (int x = pixels_.x0 + step.x0; x < pixels_.x1; x += step.spacing) {
        block.px.push_back(x);
        block.py.push_back(y);
        block.seed.push_back(hash(x));
    }
    block.count = block.px.size();
    if (block.count == 0) {
        return;
    }
    const std::size_t padded = block.num_packets() * geo::RayPacket::size;
    block.px.resize(padded, block.px.back());
    block.py.resize(padded, block.py.back());
    block.seed.resize(padded, block.seed.back());
    block.x.assign(padded, 0.5f);
    block.y.assign(padded, 0.5f);
    block.time.assign(padded, tools_.frame.spaces.shutter_open());
    block.lens_x.assign(tools_.camera.lens_radius() > 0 ? padded : 0, 0.0f);
    block.lens_y.assign(block.lens_x.size(), 0.0f);
    w.packets.resize(block.num_packets());
    tools_.camera.make_rays(block, w.packets);
    w.samples.assign(block.count, {});
    RayBundle rays;
    rays.count = static_cast<std::uint32_t>(block.count);
    rays.packets = w.packets;
    rays.seeds = block.seed;
    w.thread.wanted = &wanted;
    w.layers.trace(rays, {.samples = w.samples, .extra = {}});
    w.thread.wanted = nullptr;
    w.thread.printed.clear();
}

bool IndirectPrepass::find_wanted(const Step& step, std::vector<WantedPoints>& wanted) {
    std::vector<int> rows;
    for (int y = pixels_.y0 + step.y0; y < pixels_.y1; y += step.spacing) {
        rows.push_back(y);
    }
    wanted.assign(rows.size(), {});
    bool is_done = true;
    base::parallel_for(rows.size(), tools_.num_threads, [&](std::size_t item, int slot) {
        if (tools_.wants_stop()) {
            return false;
        }
        shade_row(step, rows[item], worker(slot), wanted[item]);
        return true;
    });
    is_done = !tools_.wants_stop();
    return is_done;
}

IrradianceRecord IndirectPrepass::make_record(const DiffusePoint& point, Worker& w) const {
    const DiffuseRays::Asker asker{tools_.frame, w.thread, 0, 0};
    float harmonic_mean = 0;
    IrradianceRecord record = HemisphereGather(asker).record(point, harmonic_mean);
    // A pixel's width where the point is; wider along surfaces that lean away, up to four times.
    const float away = base::length(point.P);
    const float cosine = std::fabs(base::dot(point.N, point.P)) / std::max(away, 1e-30f);
    const float px = tools_.camera.footprint(away, 1) / std::max(cosine, 0.25f);
    const float error = point.settings.max_error;
    record.radius = record_radius(record, harmonic_mean, least_reach_px * px / error,
                                  point.settings.max_pixel_distance * px / error);
    limit_gradients(record);
    return record;
}

bool IndirectPrepass::compute(const WantedPoints& points, std::vector<IrradianceRecord>& records) {
    records.assign(points.size(), {});
    const std::size_t num_items = (points.size() + records_per_item - 1) / records_per_item;
    base::parallel_for(num_items, tools_.num_threads, [&](std::size_t item, int slot) {
        if (tools_.wants_stop()) {
            return false;
        }
        const std::size_t end = std::min((item + 1) * records_per_item, points.size());
        for (std::size_t i = item * records_per_item; i < end; ++i) {
            DiffusePoint point = points[i];
            point.medium = 0; // handles of another thread
            records[i] = make_record(point, worker(slot));
        }
        return true;
    });
    return !tools_.wants_stop();
}

bool IndirectPrepass::run() {
    std::vector<WantedPoints> wanted;
    std::vector<IrradianceRecord> records;
    for (const Step& step : steps()) {
        if (!find_wanted(step, wanted)) {
            return false;
        }
        WantedPoints points;
        for (const WantedPoints& row : wanted) {
            points.insert(points.end(), row.begin(), row.end());
        }
        if (!compute(points, records)) {
            return false;
        }
        for (const IrradianceRecord& record : records) {
            light_.cache.insert(record);
        }
    }
    return true;
}

Counters IndirectPrepass::counters() const {
    Counters sum;
    for (const std::unique_ptr<Worker>& w : workers_) {
        if (w) {
            sum += w->thread.counters;
        }
    }
    return sum;
}

} // namespace trace
