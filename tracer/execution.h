// SPDX-License-Identifier: Apache-2.0
// What a running shader stands in: the frame, the thread's scratch, the points being shaded. A
// pointer to an Execution is the `engine` every service of runtime/abi/sl_services.def gets.
// Executions live with the batch they run (shade_job.h); lights get one of their own that refers to
// the one that asked.
#pragma once

#include "geometry/world.h"
#include "ribtools/scene.h"
#include "runtime/batch.h"
#include "runtime/shader.h"
#include "runtime/uniform_prints.h"
#include "tracer/bad_values.h"
#include "tracer/shadeop_call.h"
#include "tracer/spaces.h"
#include "tracer/stats.h"

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace base {
class ShadeopLibrary;
}

namespace trace {

struct DeepestMiss;
struct ShaderEntry;
class ShaderSet;
class IndirectLight;
struct DiffusePoint;
struct IndirectBatch;
class LightSet;
class LightRun;
struct LightScratch;
class PatternCache;
struct LightList;
class PixelTrace;
class RayLevels;
class ShadeJobs;
class ShaderProfile;
class TextureFrame;

// Immutable for the frame, shared by all threads. world, shaders and lights are null while shaders
// are bound.
struct FrameContext {
    const rib::Scene& scene;
    const Spaces& spaces;
    rt::StringTable& strings;
    base::Diag& diag;
    const geo::World* world = nullptr;
    const ShaderSet* shaders = nullptr;
    const LightSet* lights = nullptr;
    base::ShadeopLibrary* shadeops = nullptr; // functions of DSOs; none: nothing is allowed
    const TextureFrame* textures = nullptr;   // null while shaders are bound
    bool (*interrupted)() = nullptr;          // true: long shaders end now, whatever they return
    // Iterations of loops a packet may run: Option "limits" "loopsteps".
    std::uint32_t max_loop_steps = default_loop_steps;

    rt::ShaderLibrary* library = nullptr;    // null: shaders cannot be made any more
    BadPlace* bad_place = nullptr;           // told by checked code; one thread only
    const IndirectLight* indirect = nullptr; // null: there is none

    static constexpr std::uint32_t default_loop_steps = 1U << 20;
};

// Matrices found for the running batch, by the addresses of the names: emitted code asks once per
// packet.
struct SpaceCache {
    struct Item {
        sl_string from = nullptr, to = nullptr;
        bool known = false;
        std::array<float, 16> m{};
    };
    static constexpr std::size_t capacity = 16;
    std::array<Item, capacity> items;
    std::size_t size = 0;
};

// Scratch of one thread.
struct ThreadState {
    ThreadState();
    ~ThreadState();

    Counters counters;
    std::unique_ptr<ShadeJobs> jobs;        // what batches are shaded in
    std::unique_ptr<RayLevels> levels;      // who shades what rays of shaders meet
    std::unique_ptr<PatternCache> patterns; // of match()
    std::vector<ShadeopItem> shadeops;      // functions of DSOs that were called
    std::unique_ptr<LightScratch> lights;   // light_run.h, made on first use
    std::uint64_t batch_serial = 0;         // grows with every run of a shader on a batch
    std::string printed;                    // printf of the bucket in work
    PixelTrace* trace = nullptr;            // --trace-pixel: told what happens
    ShaderProfile* profile = nullptr;       // --profile-shaders: this thread's rows
    BadValues bad;                          // results that were no numbers
    // A rehearsal: points whose indirect light is not known yet are noted here, and nothing that is
    // shaded counts (indirect_prepass.h).
    std::vector<DiffusePoint>* wanted = nullptr;
    bool is_abandoned = false; // a shader was interrupted: what is in work is worth nothing
};

// A shader that runs or has run on the points of a batch, and the batch that holds its values.
struct StageRun {
    const ShaderEntry* shader = nullptr;
    rt::ShadeBatch* batch = nullptr;
};

// The rays that found the points of a batch, as shaders may ask and as the next rays need it; by
// point, empty: unknown. Seeds: what random numbers of a point are made from, whoever needs them.
struct RaySubject {
    int level = 0;            // 0: camera
    int kind = SL_RAY_camera; // SL_RAY_*
    int diffuse_level = 0;    // diffuse rays among those before
    std::span<const std::uint32_t> seeds;
    std::span<const float> lengths;         // of the rays, in units of length
    std::span<const float> spread;          // growth of the footprint per unit of length
    std::span<const std::uint32_t> media;   // media.h: what the ray came through
    std::span<const sl_string> labels;      // null: none was given
    std::span<const std::uint32_t> samples; // of the bucket, for --trace-pixel
};

// Points of one batch that came from rays. All belong to attribute states that shade alike; where a
// shader's facts ask for it also to one object space or one attribute state.
struct BatchSubject {
    std::span<const geo::Hit> hits;
    const LightList* lights = nullptr;
    std::uint32_t attributes = geo::no_id; // of the first point
    geo::Incident incident{};              // the rays, if a shader asks for messages
    // What messages see; shaders that have not run answer with the values of their calls.
    StageRun displacement{}, surface{}, atmosphere{};
    // Differences of P at the auxiliary points, planes of the batch's stride; null: not known.
    const float *P_u = nullptr, *P_v = nullptr;
    RaySubject rays{};
    // Deepest rays that met nothing, of those the points asked for (shade_job.h); null: nobody
    // asks.
    std::vector<DeepestMiss>* misses = nullptr;
};

class Execution {
public:
    Execution(const FrameContext& frame_, const ShaderEntry& running_)
        : frame(frame_), running(running_) {}
    Execution(const Execution&) = delete;
    Execution& operator=(const Execution&) = delete;

    const FrameContext& frame;
    const ShaderEntry& running;
    ThreadState* thread = nullptr; // null while parameters are bound
    rt::ShadeBatch* batch = nullptr;
    const BatchSubject* subject = nullptr;
    const Execution* asked_by = nullptr; // a light's: the execution that lights its points,
    std::uint32_t asked_first = 0;       // the index there of its first point,
    std::uint32_t asked_mask = 0;        // and the lanes that were asked
    std::uint64_t serial = 0;            // of this run: what lights found for others is told by it
    LightRun* light = nullptr;           // a light's: its working memory,
    std::int32_t light_sample = 0;       // and the sample it is asked for
    int ray_level = 0;
    int ray_kind = SL_RAY_camera;
    std::shared_ptr<IndirectBatch> indirect; // of the batch's points, once one has asked
    SpaceCache spaces;
    rt::UniformPrints uniform_prints;

    // Points per packet of the running variant: the plane length of everything the services
    // exchange.
    [[nodiscard]] std::uint32_t lanes() const;
};

// The shader waits where nobody answers (a light, an imager, parameters): reported once; its points
// keep the values they have.
void report_suspended(const Execution& execution);

// A message about the running shader, once per shader and text. Line 0: the place of the call;
// `file`: the shader's own if empty.
void report_shader(const Execution& execution, base::Severity severity, int line,
                   std::string_view text, std::string_view file = {});

// Option "limits" "loopsteps", or its default.
[[nodiscard]] std::uint32_t max_loop_steps(const rib::Options& options);

} // namespace trace
