// SPDX-License-Identifier: Apache-2.0
#include "tracer/frame.h"

#include "geometry/world.h"
#include "runtime/base/output_file.h"
#include "runtime/base/parallel.h"
#include "tracer/bucket.h"
#include "tracer/bucket_order.h"
#include "tracer/camera.h"
#include "tracer/develop.h"
#include "tracer/display.h"
#include "tracer/energy_check.h"
#include "tracer/filter.h"
#include "tracer/frame_hash.h"
#include "tracer/imager.h"
#include "tracer/indirect_frame.h"
#include "tracer/lights.h"
#include "tracer/live_display.h"
#include "tracer/not_done.h"
#include "tracer/output_bindings.h"
#include "tracer/pixel_trace.h"
#include "tracer/preview.h"
#include "tracer/quantize.h"
#include "tracer/sampler.h"
#include "tracer/shader_profile.h"
#include "tracer/shader_set.h"
#include "tracer/shading_classes.h"
#include "tracer/specialise.h"
#include "tracer/texture_frame.h"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <new>
#include <optional>
#include <vector>

namespace trace {

namespace {

bool wants_stop(const RenderSettings& settings, const base::Diag& diag) {
    return (settings.interrupted != nullptr && settings.interrupted()) || diag.abort_requested();
}

// Text of printf leaves in the order of the buckets, whichever finished first.
class OrderedPrinter {
public:
    explicit OrderedPrinter(std::size_t num_items) : texts_(num_items), done_(num_items) {}

    void finish(std::size_t item, std::string&& text) {
        const std::lock_guard lock(mutex_);
        texts_[item] = std::move(text);
        done_[item] = true;
        for (; next_ < texts_.size() && done_[next_]; ++next_) {
            std::fwrite(texts_[next_].data(), 1, texts_[next_].size(), stdout);
            texts_[next_] = {};
        }
    }

private:
    std::mutex mutex_;
    std::vector<std::string> texts_;
    std::vector<bool> done_;
    std::size_t next_ = 0;
};

// All that is made from a scene before the first ray, in the order it is made.
class Frame {
public:
    Frame(const rib::Scene& scene, const RenderSettings& settings, const FrameTools& tools,
          const std::vector<rib::Display>& displays)
        : scene_(scene), settings_(settings), tools_(tools), camera_(scene, tools.diag),
          spaces_(scene, {camera_.screen_from_camera(), camera_.ndc_from_screen(),
                          camera_.raster_from_screen()}) {
        report_not_done(scene, tools.diag);
        if (tools.textures == nullptr) {
            own_textures_ = std::make_unique<Textures>();
        }
        const Space* world = spaces_.find("world");
        textures_ = std::make_unique<TextureFrame>(
            own_textures_ ? *own_textures_ : *tools.textures, scene.options,
            world != nullptr ? world->space_from_camera : base::Mat4{});
        {
            const PhaseTimer timer(tools.stats, Phase::shaders);
            shaders_ = std::make_unique<ShaderSet>(
                ShaderSources{scene, spaces_, tools.library, tools.strings, tools.diag});
            lights_ = std::make_unique<LightSet>(scene, *shaders_);
            classes_ = std::make_unique<ShadingClasses>(scene, *shaders_, *lights_);
            outputs_ = OutputSet(displays, scene.options, shader_outputs(*classes_), tools.diag);
            bindings_ = OutputBindings(outputs_, *classes_, tools.diag);
        }
        indirect_ = std::make_unique<IndirectLight>(scene);
        const PhaseTimer timer(tools.stats, Phase::geometry);
        world_ = geo::World::build(scene,
                                   {camera_.view(), scene.options.shutter_open,
                                    settings.num_threads, shaded_opacity(scene, *shaders_)},
                                   tools.diag);
        add_world_stats();
        lights_->take_world(context());
    }

    [[nodiscard]] const Camera& camera() const { return camera_; }
    [[nodiscard]] FrameContext context() const {
        return {scene_,
                spaces_,
                tools_.strings,
                tools_.diag,
                world_.get(),
                shaders_.get(),
                lights_.get(),
                settings_.shadeops,
                textures_.get(),
                settings_.interrupted,
                max_loop_steps(scene_.options),
                &tools_.library,
                nullptr,
                indirect_->is_used() ? indirect_.get() : nullptr};
    }
    void add_stats(const Counters& counted) const {
        tools_.stats.add(counted, shaders_->names(), tick_rate_.seconds_per_tick());
    }
    [[nodiscard]] const OutputSet& outputs() const { return outputs_; }
    [[nodiscard]] const ShaderEntry* imager() const { return shaders_->get(scene_.options.imager); }

    [[nodiscard]] Checkpoint::Hash hash() const { return frame_hash(scene_, *shaders_); }

    // Who else takes part; each may be null. With a trace: its pixel only, and the trace is told
    // what happens.
    struct Company {
        Checkpoint* checkpoint = nullptr;
        PixelTrace* trace = nullptr;
        const DisplayPlan* shown = nullptr; // by settings.live, meanwhile
    };
    FrameResult render(Image& image, const Company& company) const;

    // What does not depend on the pixels that are rendered; call once, before. False: interrupted.
    [[nodiscard]] bool prepare() const;
    // --check-energy: prints a table, reports shaders that give light away.
    void check_energy() const;

private:
    bool show(Film& film, const DisplayPlan* shown) const;
    FrameResult render_buckets(Film& film, const Sampler& sampler,
                               const std::vector<std::size_t>& order, PixelTrace* trace,
                               BadValues& bad) const;
    void render_again(const PixelRange& pixels, const Sampler& sampler,
                      const FilterWeights& weights, BadPlace& place) const;
    [[nodiscard]] Specialiser::Settings special_settings(bool is_traced) const;
    void add_world_stats() const;
    void write_baked(bool wanted) const;
    void add_film_stats(const Film& film) const;

    const rib::Scene& scene_;
    const RenderSettings& settings_;
    const FrameTools& tools_;
    base::TickRate tick_rate_;
    Camera camera_;
    Spaces spaces_;
    std::unique_ptr<Textures> own_textures_;
    std::unique_ptr<TextureFrame> textures_;
    std::unique_ptr<ShaderSet> shaders_;
    std::unique_ptr<LightSet> lights_;
    std::unique_ptr<ShadingClasses> classes_;
    std::unique_ptr<IndirectLight> indirect_;
    OutputSet outputs_;
    OutputBindings bindings_;
    std::unique_ptr<geo::World> world_;
};

// Samples that wait for those of neighbours, at most, when rows are not rendered in order.
constexpr std::size_t max_waiting_bytes = std::size_t{512} << 20;

// Rows of buckets whose samples fit.
int rows_at_once(const Film& film, const Sampler& sampler) {
    if (film.num_buckets() == 0) {
        return 1;
    }
    const std::size_t sample_bytes = sizeof(Sample) + film.image().extra.size() * sizeof(float);
    const std::size_t bytes = film.sample_pixels(0).area() *
                              static_cast<std::size_t>(sampler.per_pixel()) * sample_bytes *
                              static_cast<std::size_t>(film.columns());
    return static_cast<int>(std::clamp<std::size_t>(max_waiting_bytes / bytes, 1, 1 << 20));
}

// False: nobody watches.
bool Frame::show(Film& film, const DisplayPlan* shown) const {
    FilmObserver* viewer =
        shown != nullptr ? settings_.live->begin_frame(*shown, scene_.options, film.image().pixels,
                                                       film.num_buckets())
                         : nullptr;
    if (viewer != nullptr) {
        film.add_observer(*viewer);
    }
    return viewer != nullptr;
}

bool Frame::prepare() const {
    const PhaseTimer timer(tools_.stats, Phase::indirect);
    const FrameContext frame = context();
    const IndirectPrepass::Tools tools{frame, camera_, *classes_, settings_.num_threads,
                                       [this] { return wants_stop(settings_, tools_.diag); }};
    Counters counters;
    const bool is_done = prepare_indirect(*indirect_, tools, counters);
    add_stats(counters);
    tools_.stats.amounts[Amount::irradiance_records] = indirect_->cache.records().size();
    tools_.stats.amounts[Amount::irradiance_bytes] = indirect_->cache.memory_bytes();
    return is_done;
}

void Frame::check_energy() const {
    const FrameContext frame = context();
    ThreadState thread;
    const std::vector<EnergyRow> rows = EnergyCheck(frame, camera_, *classes_, thread).run();
    const std::string text = energy_text(rows);
    std::fwrite(text.data(), 1, text.size(), stdout);
    report_energy(rows, tools_.diag);
}

FrameResult Frame::render(Image& image, const Company& company) const {
    const auto& [checkpoint, trace, shown] = company;
    const PhaseTimer timer(tools_.stats, Phase::render);
    const rib::Options& options = scene_.options;
    const Sampler sampler(sampler_settings(options, tools_.diag));
    const Filter filter(options.filter, options.filter_width[0], options.filter_width[1],
                        tools_.diag, options.filter_pos);
    const FilterWeights weights(filter, sampler);
    Raster raster = camera_.raster();
    if (trace != nullptr) { // crop windows do not change a pixel (film-003)
        raster.crop = trace->pixel();
    }
    const auto output_weights = outputs_.weights(sampler, tools_.diag);
    FilmSettings settings = film_settings(options, tools_.diag);
    settings.extra = outputs_.film_channels(output_weights);
    const std::unique_ptr<Film> film =
        Film::create(raster, sampler, weights, settings, tools_.diag);
    if (!film) {
        return FrameResult::Failed;
    }
    const int every = show(*film, shown) ? settings_.live->settings().every : 1;
    if (checkpoint != nullptr) {
        checkpoint->start(*film);
    }
    BadValues bad;
    const FrameResult result = render_buckets(
        *film, sampler,
        coarse_first(film->num_buckets(), film->columns(), every, rows_at_once(*film, sampler)),
        trace, bad);
    if (trace == nullptr) {
        const auto again = [&](std::size_t bucket, BadPlace& place) {
            render_again(film->output_pixels(bucket), sampler, weights, place);
        };
        const bool may_render = result != FrameResult::Interrupted;
        report_bad_values(context(), bad, may_render ? ShadeAgain(again) : ShadeAgain());
    }
    if (trace != nullptr) {
        trace->finish(sampler, weights, film->image());
    }
    add_film_stats(*film);
    write_baked(result == FrameResult::Done && trace == nullptr);
    if (checkpoint != nullptr) {
        checkpoint->finish();
    }
    image = std::move(film->image());
    return result;
}

FrameResult Frame::render_buckets(Film& film, const Sampler& sampler,
                                  const std::vector<std::size_t>& order, PixelTrace* trace,
                                  BadValues& bad) const {
    const FrameContext frame = context();
    const VisibilityOptions visibility = visibility_options(scene_.options);
    const auto num_slots = static_cast<std::size_t>(base::thread_count(settings_.num_threads));
    std::vector<ShaderProfile> profiles(num_slots);
    std::vector<std::unique_ptr<BucketRenderer>> renderers(num_slots);
    Specialiser specialiser(special_settings(trace != nullptr), *classes_, *lights_, tools_.library,
                            tools_.diag);
    std::atomic<std::size_t> num_done{0};
    OrderedPrinter printer(film.num_buckets());
    Progress progress(trace == nullptr ? settings_.progress : ProgressMode::None, stderr);
    progress.start("render", film.num_buckets());
    base::parallel_for(order.size(), settings_.num_threads, [&](std::size_t item, int slot) {
        if (wants_stop(settings_, tools_.diag)) {
            return false;
        }
        const std::size_t bucket = order[item];
        if (!film.needs_samples(bucket)) { // an earlier run has finished all around it
            ++num_done;
            printer.finish(bucket, {});
            progress.advance();
            return true;
        }
        std::unique_ptr<BucketRenderer>& renderer = renderers[static_cast<std::size_t>(slot)];
        if (!renderer) {
            renderer = std::make_unique<BucketRenderer>(frame, camera_, sampler, *classes_,
                                                        &bindings_, visibility);
            renderer->thread().trace = trace;
            renderer->thread().profile =
                tools_.listing != nullptr ? &profiles[static_cast<std::size_t>(slot)] : nullptr;
        }
        renderer->thread().bad.begin_bucket(bucket);
        if (!renderer->render(bucket, film)) {
            return false;
        }
        printer.finish(bucket, std::move(renderer->thread().printed));
        renderer->thread().printed.clear();
        progress.advance();
        specialiser.progress(++num_done, order.size());
        return true;
    });
    progress.finish();
    Counters counters;
    for (const auto& renderer : renderers) {
        if (renderer) {
            counters += renderer->thread().counters;
            bad.add(renderer->thread().bad);
        }
    }
    for (std::size_t slot = 0; tools_.listing != nullptr && slot < num_slots; ++slot) {
        tools_.listing->add(profiles[slot], tick_rate_.seconds_per_tick());
    }
    counters.add(Counter::special_used, specialiser.num_special());
    add_stats(counters);
    return film.complete() ? FrameResult::Done : FrameResult::Interrupted;
}

// For messages: what shaders tell counts, nothing of the picture.
void Frame::render_again(const PixelRange& pixels, const Sampler& sampler,
                         const FilterWeights& weights, BadPlace& place) const {
    Raster raster = camera_.raster();
    raster.crop = pixels;
    FilmSettings settings = film_settings(scene_.options, tools_.diag);
    settings.extra = outputs_.film_channels(outputs_.weights(sampler, tools_.diag));
    const std::unique_ptr<Film> film =
        pixels.area() > 0 ? Film::create(raster, sampler, weights, settings, tools_.diag) : nullptr;
    FrameContext frame = context();
    frame.bad_place = &place;
    BucketRenderer renderer(frame, camera_, sampler, *classes_, &bindings_,
                            visibility_options(scene_.options));
    for (std::size_t bucket = 0; film && bucket < film->num_buckets() && !place.is_found();
         ++bucket) {
        if (!renderer.render(bucket, *film)) {
            return;
        }
    }
}

// A traced pixel tells of all variables the shader names.
Specialiser::Settings Frame::special_settings(bool is_traced) const {
    Specialiser::Settings settings;
    settings.mode = is_traced ? SpecialMode::Off : settings_.specialise;
    settings.num_threads = base::thread_count(settings_.num_threads);
    settings.is_verbose = settings_.is_verbose;
    settings.for_profile = tools_.listing != nullptr && !is_traced;
    settings.interrupted = settings_.interrupted;
    return settings;
}

void Frame::add_world_stats() const {
    const geo::Stats& world = world_->stats();
    PerRow<Amount, std::uint64_t>& amounts = tools_.stats.amounts;
    amounts[Amount::shapes] = world.shapes;
    amounts[Amount::triangles] = world.triangles;
    amounts[Amount::quadrics] = world.quadrics;
    amounts[Amount::grids] = world.grids;
    amounts[Amount::instances] = world.instances;
    amounts[Amount::geometry_bytes] = world.bytes;
    amounts[Amount::embree_bytes] = world.embree_bytes;
    amounts[Amount::lights] = scene_.lights.size();
    amounts[Amount::threads] =
        static_cast<std::uint64_t>(base::thread_count(settings_.num_threads));
}

// Files of bake() and bake3d(); those of an unfinished frame would lack samples.
void Frame::write_baked(bool wanted) const {
    PointFiles& points = textures_->textures().points();
    if (!wanted) {
        points.discard();
        return;
    }
    for (const PointFiles::Failure& failure : points.write()) {
        tools_.diag.report(base::Severity::Severe, base::Code::System, {},
                           "cannot write the samples of " + failure.path + ": " + failure.why);
    }
}

void Frame::add_film_stats(const Film& film) const {
    std::uint64_t num_pixels = 0;
    for (std::size_t bucket = 0; bucket < film.num_buckets(); ++bucket) {
        num_pixels += film.sample_pixels(bucket).area();
    }
    std::uint64_t bytes = film.peak_bytes();
    for (const std::vector<float>& plane : film.image().planes) {
        bytes += plane.size() * sizeof(float);
    }
    for (const std::vector<float>& plane : film.image().extra) {
        bytes += plane.size() * sizeof(float);
    }
    tools_.stats.amounts[Amount::sample_pixels] = num_pixels;
    tools_.stats.amounts[Amount::film_bytes] = bytes;
    const Textures::Memory maps = textures_->textures().memory();
    tools_.stats.amounts[Amount::texture_bytes] = maps.tile_bytes + maps.map_bytes;
    tools_.stats.amounts[Amount::texture_read_bytes] = maps.bytes_read;
}

// The displays of the frame; a scene that names none gets the default one. Where all are windows
// the first one's picture goes to a file too: nothing is lost when the window closes (live-006).
std::vector<rib::Display> displays_of(const rib::Options& options, const RenderSettings& settings,
                                      base::Diag& diag) {
    std::vector<rib::Display> displays = options.displays;
    if (displays.empty() && !settings.default_output.empty()) {
        displays.push_back(default_display(settings.default_output, "rgba"));
    }
    const auto window = std::find_if(displays.begin(), displays.end(), shows_window);
    if (window != displays.end() && std::none_of(displays.begin(), displays.end(), leaves_file)) {
        const rib::Display file = file_of_window(*window, settings.default_output);
        diag.report_once("window-file", base::Severity::Info, base::Code::None, window->pos,
                         "Display \"" + window->name + "\" \"" + window->type +
                             "\": no other display leaves a file; the picture also goes to " +
                             file.name);
        displays.push_back(file);
    }
    return displays;
}

// The display that settings.live shows, or null.
const DisplayPlan* shown_plan(const OutputSet& outputs, const RenderSettings& settings) {
    return settings.live != nullptr ? settings.live->shown(outputs.displays()) : nullptr;
}

bool all_exist(const std::vector<rib::Display>& displays) {
    return std::any_of(displays.begin(), displays.end(), leaves_file) &&
           std::all_of(displays.begin(), displays.end(), [](const rib::Display& display) {
               const std::optional<std::string> file = display_file(display);
               std::error_code error;
               return !leaves_file(display) || (file && std::filesystem::exists(*file, error));
           });
}

// Asked before an hour of rendering, not after it. False: no display can be written, and the user
// knows why.
bool can_write(const std::vector<rib::Display>& displays, base::Diag& diag) {
    std::vector<std::pair<const rib::Display*, std::string>> problems;
    for (const rib::Display& display : displays) {
        const std::optional<std::string> file = display_file(display);
        std::string why = file ? base::why_not_writable(*file) : std::string();
        if (why.empty()) {
            return true;
        }
        problems.emplace_back(&display, *file + ": " + why);
    }
    for (const auto& [display, problem] : problems) {
        diag.report(base::Severity::Severe, base::Code::System, display->pos,
                    "Display: cannot write " + problem + "; the frame is not rendered");
    }
    return displays.empty();
}

// Beside the first picture.
std::string checkpoint_of(const std::vector<rib::Display>& displays,
                          const CheckpointSettings& settings) {
    for (const rib::Display& display : displays) {
        if (const std::optional<std::string> file = display_file(display)) {
            return checkpoint_path(*file, settings.directory);
        }
    }
    return "";
}

FrameResult write_displays(const Frame& frame, const RenderSettings& settings,
                           const FrameTools& tools, Image&& image) {
    const PhaseTimer timer(tools.stats, Phase::write);
    const std::vector<DisplayPlan>& plans = frame.outputs().displays();
    const DisplayPlan* shown = shown_plan(frame.outputs(), settings);
    Counters counters;
    Developer developer(frame.context(), frame.imager(), settings.num_threads, counters, plans,
                        std::move(image));
    FrameResult result = FrameResult::Done;
    for (const DisplayPlan& plan : plans) {
        if (wants_stop(settings, tools.diag)) {
            return FrameResult::Interrupted;
        }
        if (&plan != shown && !leaves_file(plan.display)) {
            continue;
        }
        const Image& picture = developer.developed(plan);
        if (&plan == shown) {
            settings.live->show_final(picture);
        }
        const DisplayResult written =
            write_display(plan, picture, picture_info(frame.camera()), tools.diag);
        result = written == DisplayResult::Failed ? FrameResult::Failed : result;
        if (tools.preview != nullptr && tools.preview->png.empty()) {
            *tools.preview = make_preview(picture, plan);
        }
    }
    frame.add_stats(counters);
    return result;
}

// --trace-pixel: prints what the pixels did, writes no picture.
FrameResult trace_pixels(const Frame& frame, const RenderSettings& settings,
                         const FrameTools& tools) {
    const std::vector<DisplayPlan>& plans = frame.outputs().displays();
    const PixelRange rendered = frame.camera().raster().rendered();
    const FrameContext context = frame.context();
    for (const auto& [x, y] : settings.trace_pixels) {
        if (!rendered.contains(x, y)) {
            report_outside(x, y, rendered, tools.diag);
            continue;
        }
        PixelTrace trace(context, x, y);
        Image filtered;
        const FrameResult result =
            frame.render(filtered, {.checkpoint = nullptr, .trace = &trace, .shown = nullptr});
        if (result != FrameResult::Done) {
            return result;
        }
        std::string text = trace.text();
        Counters counters;
        Developer exposed(context, nullptr, settings.num_threads, counters, plans, Image(filtered));
        Developer developer(context, frame.imager(), settings.num_threads, counters, plans,
                            std::move(filtered));
        for (const DisplayPlan& plan : plans) {
            text += display_text(plan, exposed.developed(plan));
            const Image& picture = developer.developed(plan);
            text += frame.imager() != nullptr ? imaged_text(picture, frame.imager()->name) : "";
            text += channels_text(plan, picture);
        }
        std::fwrite(text.data(), 1, text.size(), stdout);
    }
    return FrameResult::Done;
}

} // namespace

FrameResult render_image(const rib::Scene& scene, const RenderSettings& settings,
                         const FrameTools& tools, Image& image) {
    const Frame frame(scene, settings, tools, scene.options.displays);
    return frame.prepare() ? frame.render(image, {}) : FrameResult::Interrupted;
}

FrameResult render_frame(const rib::Scene& scene, const RenderSettings& settings,
                         const FrameTools& tools) {
    const std::vector<rib::Display> displays = displays_of(scene.options, settings, tools.diag);
    const bool makes_picture = settings.trace_pixels.empty() && !settings.check_energy;
    if (settings.keep_existing && makes_picture && all_exist(displays)) {
        tools.diag.report(base::Severity::Info, base::Code::None, {},
                          "frame " + std::to_string(scene.options.frame) +
                              ": its pictures exist; skipped");
        return FrameResult::Done;
    }
    if (makes_picture && !can_write(displays, tools.diag)) {
        return FrameResult::Failed;
    }
    const Frame frame(scene, settings, tools, displays);
    if (wants_stop(settings, tools.diag)) {
        return FrameResult::Interrupted;
    }
    if (settings.check_energy) {
        frame.check_energy();
        return FrameResult::Done;
    }
    if (!frame.prepare()) {
        return FrameResult::Interrupted;
    }
    if (!settings.trace_pixels.empty()) {
        return trace_pixels(frame, settings, tools);
    }
    Checkpoint checkpoint(
        settings.checkpoint, checkpoint_of(displays, settings.checkpoint),
        [&frame] { return frame.hash(); }, tools.diag);
    Image image;
    FrameResult result = frame.render(image, {.checkpoint = &checkpoint,
                                              .trace = nullptr,
                                              .shown = shown_plan(frame.outputs(), settings)});
    if (result == FrameResult::Done) {
        result = write_displays(frame, settings, tools, std::move(image));
    }
    if (result == FrameResult::Done) {
        checkpoint.remove();
    } else {
        checkpoint.report_kept();
    }
    if (settings.live != nullptr) {
        settings.live->end_frame(result != FrameResult::Interrupted);
    }
    return result;
}

} // namespace trace
