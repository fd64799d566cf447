// SPDX-License-Identifier: Apache-2.0
#include "tracer/imager.h"

#include "runtime/base/parallel.h"
#include "runtime/base/ticks.h"
#include "tracer/services.h"
#include "tracer/shade_job.h"
#include "tracer/shader_set.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace trace {

namespace {

// The plane of the picture behind each component of Ci, Oi and alpha.
struct Channel {
    sl_variable variable;
    int component;
    Plane plane;
};
constexpr Channel channels[] = {
    {SL_VAR_Ci, 0, Plane::R},    {SL_VAR_Ci, 1, Plane::G},  {SL_VAR_Ci, 2, Plane::B},
    {SL_VAR_Oi, 0, Plane::OR},   {SL_VAR_Oi, 1, Plane::OG}, {SL_VAR_Oi, 2, Plane::OB},
    {SL_VAR_alpha, 0, Plane::A},
};

class ImagerRun {
public:
    ImagerRun(const FrameContext& frame, const ShaderEntry& imager, Image& image)
        : frame_(frame), imager_(imager), image_(image) {}

    // Pixels first .. first+count-1 of the picture, row by row.
    void run(ThreadState& thread, std::size_t first, std::uint32_t count) {
        if (!thread.jobs) {
            thread.jobs = std::make_unique<ShadeJobs>();
        }
        ShadeJob& job = thread.jobs->take();
        rt::ShadeBatch& batch = job.surface;
        batch.begin(imager_.current(), count);
        fill(batch, first);
        Execution execution(frame_, imager_);
        execution.thread = &thread;
        execution.batch = &batch;
        const std::uint64_t start = base::ticks();
        if (batch.run({&service_table(), &execution}) != 0) {
            report_suspended(execution);
        }
        ShaderCounters& of_shader = thread.counters.shader(imager_.number);
        of_shader.add_time(base::ticks() - start);
        of_shader.add_batch(count, batch.num_packets(), execution.lanes());
        thread.counters.add(Counter::points_imager, count);
        const std::uint64_t num_bad = read_back(batch, first);
        thread.counters.add(Counter::bad_values, num_bad);
        thread.bad.begin_bucket(first / SL_BATCH_MAX);
        thread.bad.note(imager_, BadResult::Imager, num_bad);
        thread.jobs->give(job);
    }

private:
    void fill(rt::ShadeBatch& batch, std::size_t first) const {
        for (const Channel& c : channels) {
            if (float* to = batch.plane(c.variable, c.component)) {
                std::copy_n(image_.plane(c.plane).begin() + static_cast<std::ptrdiff_t>(first),
                            batch.count(), to);
            }
        }
        const rib::Options& options = frame_.scene.options;
        const auto width = static_cast<std::size_t>(image_.pixels.width());
        for (std::uint32_t i = 0; i < batch.count(); ++i) {
            const auto px = static_cast<std::uint32_t>(image_.pixels.x0) +
                            static_cast<std::uint32_t>((first + i) % width);
            const auto py = static_cast<std::uint32_t>(image_.pixels.y0) +
                            static_cast<std::uint32_t>((first + i) / width);
            const float x = static_cast<float>(px) + 0.5f, y = static_cast<float>(py) + 0.5f;
            set(batch, SL_VAR_P, 0, i, x);
            set(batch, SL_VAR_P, 1, i, y);
            set(batch, SL_VAR_u, 0, i, x / static_cast<float>(options.xres));
            set(batch, SL_VAR_v, 0, i, y / static_cast<float>(options.yres));
            set(batch, SL_VAR_s, 0, i, x / static_cast<float>(options.xres));
            set(batch, SL_VAR_t, 0, i, y / static_cast<float>(options.yres));
            set(batch, SL_VAR_du, 0, i, 1 / static_cast<float>(options.xres));
            set(batch, SL_VAR_dv, 0, i, 1 / static_cast<float>(options.yres));
            set(batch, SL_VAR_time, 0, i, options.shutter_open);
            set(batch, SL_VAR_dtime, 0, i, options.shutter_close - options.shutter_open);
            batch.seeds()[i] = px * 0x9e3779b1U ^ py * 0x85ebca77U;
        }
        if (float* ncomps = batch.uniform(SL_VAR_ncomps)) {
            *ncomps = 3;
        }
    }

    static void set(rt::ShadeBatch& batch, sl_variable id, int component, std::uint32_t i,
                    float value) {
        if (batch.has(id)) {
            batch.plane(id, component)[i] = value;
        }
    }

    std::uint64_t read_back(rt::ShadeBatch& batch, std::size_t first) {
        std::uint64_t num_bad = 0;
        for (const Channel& c : channels) {
            const float* from = batch.plane(c.variable, c.component);
            for (std::uint32_t i = 0; from != nullptr && i < batch.count(); ++i) {
                const bool good = std::isfinite(from[i]);
                image_.plane(c.plane)[first + i] = good ? from[i] : 0;
                num_bad += good ? 0 : 1;
            }
        }
        return num_bad;
    }

    const FrameContext& frame_;
    const ShaderEntry& imager_;
    Image& image_;
};

} // namespace

void run_imager(const FrameContext& frame, const ShaderEntry& imager, Image& image, int num_threads,
                Counters& counters, bool prints) {
    const std::size_t num_pixels = image.pixels.area();
    const std::size_t num_batches = (num_pixels + SL_BATCH_MAX - 1) / SL_BATCH_MAX;
    const Image before = image; // to find where bad values arise
    std::vector<ThreadState> threads(static_cast<std::size_t>(base::thread_count(num_threads)));
    ImagerRun run(frame, imager, image);
    std::vector<std::string> printed(num_batches);
    base::parallel_for(num_batches, num_threads, [&](std::size_t item, int slot) {
        ThreadState& thread = threads[static_cast<std::size_t>(slot)];
        const std::size_t first = item * SL_BATCH_MAX;
        run.run(
            thread, first,
            static_cast<std::uint32_t>(std::min<std::size_t>(SL_BATCH_MAX, num_pixels - first)));
        if (prints) {
            printed[item].swap(thread.printed);
        }
        thread.printed.clear();
        return true;
    });
    for (const std::string& text : printed) {
        std::fwrite(text.data(), 1, text.size(), stdout);
    }
    BadValues bad;
    for (const ThreadState& thread : threads) {
        bad.add(thread.bad);
        counters += thread.counters;
    }
    report_bad_values(frame, bad, [&](std::size_t item, BadPlace& place) {
        FrameContext again = frame;
        again.bad_place = &place;
        Image scratch = before;
        ThreadState thread;
        ImagerRun(again, imager, scratch)
            .run(thread, item * SL_BATCH_MAX,
                 static_cast<std::uint32_t>(
                     std::min<std::size_t>(SL_BATCH_MAX, num_pixels - item * SL_BATCH_MAX)));
    });
}

} // namespace trace
