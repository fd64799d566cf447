// SPDX-License-Identifier: Apache-2.0
// What one pixel did, for --trace-pixel. The frame renders that pixel by the code that renders
// pictures, on one thread; the renderer tells this sink what happens (a null pointer in ThreadState
// costs one test per batch or packet), and text comes out. Nothing is computed a second time:
// values are read from the planes the shaders ran on. Format: docs/statistics.md.
#pragma once

#include "tracer/execution.h"
#include "tracer/film.h"
#include "tracer/filter.h"
#include "tracer/outputs.h"
#include "tracer/sampler.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace trace {

class PixelTrace {
public:
    PixelTrace(const FrameContext& frame, int x, int y) : frame_(frame), x_(x), y_(y) {}

    [[nodiscard]] PixelRange pixel() const { return {x_, y_, x_ + 1, y_ + 1}; }

    // --- told by the renderer; samples are numbered as in the SampleBlock of the pass in work
    void begin_pass(const SampleBlock& block);
    // A ray of a sample and what it met; the first is the camera's.
    // level: 0 of camera rays; those of shaders are indented by it.
    void ray(std::uint32_t sample, const geo::RayPacket& packet, std::size_t lane,
             const geo::Hit& hit, int level);
    // The samples of the points of the batches that follow.
    void begin_batch(std::span<const std::uint32_t> sample_of_point);
    [[nodiscard]] const std::vector<std::uint32_t>& batch() const { return sample_of_point_; }
    void before_shader(const Execution& execution, rt::ShadeBatch& batch);
    void after_shader(const Execution& execution, rt::ShadeBatch& batch);
    // What a light gave to the lanes asked; the shadow rays it took come before.
    // batch is the light's: what its shader ran on, lane by lane.
    void light(rib::LightId id, rt::ShadeBatch& batch, const sl_light_query& query,
               const sl_light_result& result, std::uint32_t reached, std::uint32_t shadowed);
    void ambient(rib::LightId id, rt::ShadeBatch& batch, std::uint32_t first, std::uint32_t mask);
    // passes: 3 planes of 8, the light that is left.
    void shadow_rays(std::uint32_t first, const geo::RayPacket& rays, const float* passes);
    // What the rays answered that a point of `shader` asked for.
    struct Answer {
        std::span<const float> color;
        float distance = 0;
        int level = 0; // of the point
    };
    void answered(std::uint32_t sample, const ShaderEntry& shader, const Answer& answer);
    // printf of a point, or of uniform values in a packet.
    void printed(std::uint32_t point, std::string_view text);
    void printed_uniform(std::uint32_t first, std::uint32_t lanes, std::string_view text);
    // Colour and opacity as they go to the film, before compositing.
    void shaded(std::span<const std::uint32_t> members, std::span<const Sample> results);
    // The sample was not shaded; its result follows from the one at a raster position.
    void reused(std::uint32_t sample, float x_px, float y_px, const Sample& result);
    // All surfaces of a layer are in the samples; the ray of `sample` goes on, this much shows.
    void composited(std::span<const Sample> samples);
    void continues(std::uint32_t sample, std::span<const float> transmitted);
    void end_bucket(const SampleBuffer& samples);

    // The film has filtered the pixel: the text is complete.
    void finish(const Sampler& sampler, const FilterWeights& weights, const Image& filtered);
    [[nodiscard]] const std::string& text() const { return text_; }

private:
    struct SampleText {
        std::uint32_t sample; // of its pass
        int pass;
        std::string text;
        bool is_hit = false; // by the ray in work
        int num_hits = 0;
        std::vector<rib::LightId> lights_told; // with their parameters, by the shader in work
    };
    [[nodiscard]] SampleText* of_sample(std::uint32_t sample);
    [[nodiscard]] SampleText* of_point(std::size_t point);
    void describe_hit(SampleText& to, const geo::RayPacket& packet, std::size_t lane,
                      const geo::Hit& hit, int level);
    void tell_light(SampleText& to, rib::LightId id, rt::ShadeBatch& batch, std::uint32_t lane,
                    const std::string& result);
    [[nodiscard]] std::string place(base::SourcePos pos) const;
    [[nodiscard]] std::string first_on(const geo::RayPacket& rays, std::uint32_t lane) const;
    [[nodiscard]] std::string primitive_title(const geo::Hit& hit) const;
    void append_filter(const Sampler& sampler, const FilterWeights& weights);

    const FrameContext& frame_;
    int x_, y_;
    int pass_ = 0;                    // in work
    std::vector<SampleText> samples_; // of the pixel, as far as they are told in full
    std::vector<std::uint32_t> sample_of_point_;
    std::string text_;
    SampleBuffer kept_; // of the pixel and those in reach of its filter
};

// What becomes of the pixel on its way to a display; pictures of one pixel.
[[nodiscard]] std::string display_text(const DisplayPlan& plan, const Image& exposed);
[[nodiscard]] std::string imaged_text(const Image& imaged, const std::string& imager);
// Every channel of the file, with its level where the display quantises.
[[nodiscard]] std::string channels_text(const DisplayPlan& plan, const Image& developed);
// An error: the pixel is not one of those that are rendered.
void report_outside(int x, int y, const PixelRange& rendered, base::Diag& diag);

} // namespace trace
