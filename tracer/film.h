// SPDX-License-Identifier: Apache-2.0
// The film: samples of buckets in, filtered pixels out.
//
// Buckets partition the rendered pixels (crop and picture) along a grid aligned to the whole frame;
// those at the border also own the samples that filters reach beyond it. A bucket is filtered by
// the thread that completes its neighbourhood, and samples are released when nobody needs them.
// Each pixel gathers its samples in one fixed order, so bucket order, threads and crop windows
// never change a byte (film-003). Source: ri.md 9.
#pragma once

#include "ribtools/scene.h"
#include "runtime/base/diag.h"
#include "tracer/camera.h"
#include "tracer/filter.h"
#include "tracer/pixel_range.h"
#include "tracer/sampler.h"

#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace trace {

// What one sample saw, composited front to back. Color premultiplied by opacity. An uncovered
// sample is as initialised.
struct alignas(32) Sample {
    float color[3] = {0, 0, 0};
    float opacity[3] = {0, 0, 0};
    float one = 1; // summed along with the rest: gives the sum of the weights. Leave it alone.
    float z = std::numeric_limits<float>::infinity(); // camera depth of what counts for depth
};
static_assert(sizeof(Sample) == 32);

// The samples of one bucket: pixels row by row, the first few samples of each in index order.
struct SampleBuffer {
    PixelRange pixels;
    std::vector<Sample> samples;
    int num_extra = 0;        // further channels (AOVs) per sample
    std::vector<float> extra; // [sample][channel]
    // Adaptive sampling: where the samples of each quarter of each pixel begin, and their number at
    // the end; empty: every pixel has equally many samples.
    std::vector<std::uint32_t> begins;

    struct Part {
        std::size_t first, count;
    };
    // The samples of pixel number `pixel`.
    [[nodiscard]] Part part(std::size_t pixel) const {
        if (!begins.empty()) {
            const std::uint32_t first = begins[pixel * quarters];
            return {first, begins[(pixel + 1) * quarters] - first};
        }
        const std::size_t each = samples.size() / pixels.area();
        return {pixel * each, each};
    }
    [[nodiscard]] std::size_t pixel(int x, int y) const {
        return static_cast<std::size_t>(y - pixels.y0) * static_cast<std::size_t>(pixels.width()) +
               static_cast<std::size_t>(x - pixels.x0);
    }
    [[nodiscard]] Part part(int x, int y) const { return part(pixel(x, y)); }
};

enum class DepthFilter : std::uint8_t { Min, Max, Average };
// Hider "depthfilter"; others are reported and replaced by min.
[[nodiscard]] DepthFilter depth_filter(const rib::Options& options, base::Diag& diag);

// Planes of a finished picture. OR OG OB are the filtered opacities, A = their mean (ri.md 9.1); an
// imager may change all of them.
enum class Plane : std::uint8_t { R, G, B, OR, OG, OB, A, Z, Count };
struct Image {
    PixelRange pixels; // in the frame; planes hold exactly these, row by row
    std::array<std::vector<float>, static_cast<std::size_t>(Plane::Count)> planes;
    std::vector<std::vector<float>> extra;

    [[nodiscard]] std::span<float> plane(Plane p) { return planes[static_cast<std::size_t>(p)]; }
    [[nodiscard]] std::span<const float> plane(Plane p) const {
        return planes[static_cast<std::size_t>(p)];
    }
    // Where pixel (x, y) of the frame stands in a plane.
    [[nodiscard]] std::ptrdiff_t index(int x, int y) const {
        return static_cast<std::ptrdiff_t>(y - pixels.y0) * pixels.width() + (x - pixels.x0);
    }
    // All of them: `planes`, then `extra`.
    [[nodiscard]] std::vector<std::span<float>> all_planes();
    [[nodiscard]] std::vector<std::span<const float>> all_planes() const;
};

// Depth of a pixel without covered samples.
constexpr float uncovered_z = std::numeric_limits<float>::infinity();

constexpr int max_bucket_px = 256; // on a side

// How the samples of a pixel become its value in an extra channel.
enum class Combine : std::uint8_t {
    Mean, // weighted by the filter; what covers nothing counts as 0
    // Of the covered samples whose weight is not zero:
    CoveredMean, // weighted
    Min,
    Max,
    Nearest, // the value of the sample nearest to the eye
    Farthest
};
struct ExtraChannel {
    Combine combine = Combine::Mean;
    const FilterWeights* weights = nullptr; // null: the film's own. They outlive the film
    float empty = 0;                        // of a pixel nothing covers; Mean does not use it
    friend bool operator==(const ExtraChannel&, const ExtraChannel&) = default;
};

struct FilmSettings {
    int bucket_x = 16, bucket_y = 16; // pixels
    DepthFilter depth = DepthFilter::Min;
    std::vector<ExtraChannel> extra{}; // equal ones beside each other are computed together
};
// Option "limits" "bucketsize", Hider "depthfilter".
[[nodiscard]] FilmSettings film_settings(const rib::Options& options, base::Diag& diag);

// Told of every bucket whose pixels are final. Called once per bucket by the thread that filtered
// it, for several buckets at the same time: be quick or hand over. The pixels of the bucket do not
// change any more; those of others may at any moment.
class FilmObserver {
public:
    virtual ~FilmObserver() = default;
    // Earlier, by the thread that rendered it: the samples are in. Its pixels become final when
    // those of its neighbours are in too.
    virtual void samples_in(std::size_t bucket, const PixelRange& pixels,
                            const SampleBuffer& samples) {
        (void)bucket, (void)pixels, (void)samples;
    }
    virtual void bucket_done(std::size_t bucket, const PixelRange& pixels, const Image& image) = 0;
};

class Film {
public:
    // nullptr when memory does not suffice, after a message (Code::NoMem: exit code 3).
    // sampler and weights must outlive the film.
    static std::unique_ptr<Film> create(const Raster& raster, const Sampler& sampler,
                                        const FilterWeights& weights, const FilmSettings& settings,
                                        base::Diag& diag);
    ~Film();
    Film(const Film&) = delete;
    Film& operator=(const Film&) = delete;

    // Buckets are numbered row by row; render them in any order, each once.
    [[nodiscard]] std::size_t num_buckets() const;
    [[nodiscard]] int columns() const { return columns_; }
    // The pixels whose samples the bucket owns: what Sampler::fill is asked for.
    [[nodiscard]] PixelRange sample_pixels(std::size_t bucket) const;
    // Those and the rest of their tiles: what must be known to decide about them.
    [[nodiscard]] PixelRange tile_pixels(std::size_t bucket) const;
    // The pixels it computes.
    [[nodiscard]] PixelRange output_pixels(std::size_t bucket) const;
    [[nodiscard]] std::size_t num_planes() const {
        return image_.planes.size() + image_.extra.size();
    }

    // Takes a bucket as finished: pixels filtered by an earlier run of the same frame, plane by
    // plane (Plane, then the extra channels). Before the first submit. False: the number of values
    // is not that of the bucket, or it was restored already. Observers added before hear of it.
    bool restore(std::size_t bucket, std::span<const float> values);
    // False: only restored buckets would use its samples, so it need not be rendered.
    [[nodiscard]] bool needs_samples(std::size_t bucket) const;

    // Before the first submit; the observer must outlive the film's work.
    void add_observer(FilmObserver& observer) { observers_.push_back(&observer); }

    // A buffer for a bucket, every sample uncovered. counts: how many samples each quarter of its
    // pixels has; empty: pixels have all the sampler gives. Thread-safe.
    [[nodiscard]] SampleBuffer buffer(std::size_t bucket,
                                      std::span<const std::uint16_t> counts = {});
    // Hands the samples of a bucket over. Filters every bucket that became complete. Thread-safe.
    // Samples that are not finite count as uncovered; see num_bad_samples().
    void submit(std::size_t bucket, SampleBuffer&& samples);

    [[nodiscard]] bool complete() const;
    [[nodiscard]] std::uint64_t num_bad_samples() const { return num_bad_; }
    // Bytes of samples held at most so far.
    [[nodiscard]] std::size_t peak_bytes() const;

    // The crop range; pixels of buckets that are not filtered yet (or lie beyond the picture) are
    // empty. Read it when no thread submits.
    [[nodiscard]] const Image& image() const { return image_; }
    [[nodiscard]] Image& image() { return image_; }

private:
    struct Bucket;
    Film(const Raster& raster, const Sampler& sampler, const FilterWeights& weights,
         const FilmSettings& settings);
    void make_buckets(const PixelRange& rendered);
    [[nodiscard]] std::vector<std::size_t> neighbours(std::size_t bucket) const;
    void release(std::size_t bucket);
    void filter_bucket(std::size_t bucket);

    const Sampler& sampler_;
    const FilterWeights& weights_;
    FilmSettings settings_;
    PixelRange picture_; // of the whole frame
    int columns_ = 0, rows_ = 0;
    int reach_x_ = 0, reach_y_ = 0; // pixels, of the widest filter
    int near_x_ = 1, near_y_ = 1;   // buckets that filters reach
    std::vector<Bucket> buckets_;
    Image image_;
    std::vector<FilmObserver*> observers_;
    std::atomic<std::uint64_t> num_bad_{0};

    mutable std::mutex mutex_; // guards what follows and the counts and buffers of the buckets
    std::size_t num_done_ = 0, bytes_held_ = 0, bytes_peak_ = 0;
    std::vector<SampleBuffer> pool_; // memory to use again
};

} // namespace trace
