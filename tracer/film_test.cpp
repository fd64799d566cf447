// SPDX-License-Identifier: Apache-2.0
// The film: sums of weights, edges of known coverage, and the same bytes whatever the order,
// threads and crop.
#include "tracer/film.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <functional>
#include <gtest/gtest.h>
#include <mutex>
#include <numeric>
#include <random>
#include <set>
#include <thread>

namespace {

using trace::Film;
using trace::Image;
using trace::Plane;
using trace::SampleBlock;
using trace::SampleBuffer;

// Sets sample i of a block.
using Scene = std::function<void(const SampleBlock& block, std::size_t i, SampleBuffer& out)>;

struct Job {
    int xres = 50, yres = 37;
    std::array<float, 4> crop{0, 1, 0, 1};
    int nx = 2, ny = 2;
    float jitter = 1;
    const char* filter = "gaussian";
    float wx = 2, wy = 2;
    trace::FilmSettings settings{};
    float frame_aspect = 0;
    unsigned order_seed = 0; // 0: in order
    int threads = 1;
};

void render_bucket(Film& film, const trace::Sampler& sampler, std::size_t bucket,
                   const Scene& scene) {
    SampleBlock block;
    sampler.fill(film.sample_pixels(bucket), block);
    SampleBuffer samples = film.buffer(bucket);
    ASSERT_EQ(samples.samples.size(), block.count);
    for (std::size_t i = 0; i < block.count; ++i) {
        scene(block, i, samples);
    }
    film.submit(bucket, std::move(samples));
}

// What an observer is told; compares what it sees then with the finished picture.
class Recorder : public trace::FilmObserver {
public:
    void samples_in(std::size_t bucket, const trace::PixelRange& pixels,
                    const SampleBuffer& samples) override {
        const std::lock_guard lock(mutex_);
        EXPECT_TRUE(sampled_.insert(bucket).second) << "bucket " << bucket << " told twice";
        EXPECT_EQ(samples.pixels.intersected(pixels), pixels);
    }
    void bucket_done(std::size_t bucket, const trace::PixelRange& pixels,
                     const Image& image) override {
        const std::lock_guard lock(mutex_);
        EXPECT_TRUE(seen_.insert(bucket).second) << "bucket " << bucket << " told twice";
        EXPECT_TRUE(sampled_.contains(bucket)) << "samples come before pixels";
        num_pixels_ += pixels.area();
        const auto at = image.pixels;
        first_.emplace_back(
            static_cast<std::size_t>((pixels.y0 - at.y0) * at.width() + pixels.x0 - at.x0), 0.0f);
        first_.back().second = image.plane(Plane::R)[first_.back().first];
    }
    void compare(const Image& finished, std::size_t num_buckets) const {
        EXPECT_EQ(seen_.size(), num_buckets);
        EXPECT_EQ(num_pixels_, finished.pixels.area());
        for (const auto& [index, value] : first_) {
            EXPECT_EQ(finished.plane(Plane::R)[index], value);
        }
    }

private:
    std::mutex mutex_;
    std::set<std::size_t> seen_, sampled_;
    std::size_t num_pixels_ = 0;
    std::vector<std::pair<std::size_t, float>> first_;
};

struct Outcome {
    Image image;
    std::uint64_t bad = 0;
    std::size_t buckets = 0, peak_bytes = 0;
};

Outcome render(const Job& job, const Scene& scene) {
    base::Diag diag;
    rib::Options o;
    o.xres = job.xres;
    o.yres = job.yres;
    o.crop = job.crop;
    o.frame_aspect = job.frame_aspect;
    const trace::Raster raster = trace::make_raster(o, diag);
    const trace::Sampler sampler({.nx = job.nx, .ny = job.ny, .jitter = job.jitter});
    const trace::FilterWeights weights(trace::Filter(job.filter, job.wx, job.wy, diag), sampler);
    const auto film = Film::create(raster, sampler, weights, job.settings, diag);
    Recorder recorder;
    film->add_observer(recorder);
    std::vector<std::size_t> order(film->num_buckets());
    std::iota(order.begin(), order.end(), std::size_t{0});
    if (job.order_seed != 0) {
        std::shuffle(order.begin(), order.end(), std::mt19937(job.order_seed));
    }
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
        for (std::size_t i = next++; i < order.size(); i = next++) {
            render_bucket(*film, sampler, order[i], scene);
        }
    };
    std::vector<std::thread> threads;
    for (int t = 1; t < job.threads; ++t) {
        threads.emplace_back(work);
    }
    work();
    for (std::thread& t : threads) {
        t.join();
    }
    EXPECT_TRUE(film->complete());
    if (job.frame_aspect == 0) { // else part of the crop lies beyond the picture
        recorder.compare(film->image(), film->num_buckets());
    }
    return {film->image(), film->num_bad_samples(), film->num_buckets(), film->peak_bytes()};
}

// Something different in every sample, some of them uncovered.
void noise_scene(const SampleBlock& b, std::size_t i, SampleBuffer& out) {
    const std::uint32_t h = b.seed[i];
    if (h % 5 == 0) {
        return;
    }
    for (int c = 0; c < 3; ++c) {
        out.samples[i].color[c] = static_cast<float>((h >> (8 * c)) & 255U) / 100.0f;
        out.samples[i].opacity[c] = static_cast<float>((h >> (7 * c + 1)) & 63U) / 63.0f;
    }
    out.samples[i].z = static_cast<float>(h >> 20) + 1;
    if (out.num_extra > 0) {
        out.extra[i] = static_cast<float>(h & 1023U);
    }
}

void set_all(trace::Sample& s, float value) {
    std::fill_n(s.color, 3, value);
    std::fill_n(s.opacity, 3, value);
}

// Covered where inside(x, y) holds, raster position in pixels.
Scene coverage(std::function<bool(double, double)> inside) {
    return [inside = std::move(inside)](const SampleBlock& b, std::size_t i, SampleBuffer& out) {
        if (inside(b.px[i] + double(b.x[i]), b.py[i] + double(b.y[i]))) {
            set_all(out.samples[i], 1);
            out.samples[i].z = 3;
        }
    };
}

bool same_bytes(const Image& a, const Image& b) {
    for (std::size_t p = 0; p < a.planes.size(); ++p) {
        if (a.planes[p].size() != b.planes[p].size() ||
            std::memcmp(a.planes[p].data(), b.planes[p].data(), a.planes[p].size() * 4) != 0) {
            return false;
        }
    }
    return a.extra == b.extra;
}

constexpr std::pair<const char*, float> filters[] = {{"box", 1},
                                                     {"box", 3},
                                                     {"gaussian", 2},
                                                     {"triangle", 2},
                                                     {"catmull-rom", 4},
                                                     {"sinc", 8},
                                                     {"disk", 3},
                                                     {"mitchell", 4},
                                                     {"blackman-harris", 4},
                                                     {"bessel", 6},
                                                     {"lanczos", 6},
                                                     {"box", 0.2f},
                                                     {"gaussian", 13},
                                                     {"separable-catmull-rom", 4}};

TEST(Film, ConstantsReproduce) {
    for (const auto& [name, width] : filters) {
        Job job{.xres = 20, .yres = 20, .filter = name, .wx = width, .wy = width};
        const auto whole = render(job, [](const SampleBlock&, std::size_t i, SampleBuffer& out) {
            set_all(out.samples[i], 1);
            out.samples[i].color[1] = 0.3f;
            out.samples[i].z = 7;
        });
        for (std::size_t i = 0; i < 400; ++i) {
            EXPECT_EQ(whole.image.plane(Plane::R)[i], 1)
                << name; // sum and divisor are the same numbers
            EXPECT_EQ(whole.image.plane(Plane::A)[i], 1) << name;
            // Products are rounded: a few units in the last place, more where negative lobes
            // cancel.
            EXPECT_NEAR(whole.image.plane(Plane::G)[i], 0.3f, 2e-5) << name << " " << width;
            EXPECT_EQ(whole.image.plane(Plane::Z)[i], 7);
        }
    }
}

TEST(Film, OrderAndThreadsChangeNothing) {
    for (const auto& [name, width] : filters) {
        Job job{.filter = name,
                .wx = width,
                .wy = width,
                .settings = {.bucket_x = 8, .bucket_y = 4, .extra = {{}}}};
        const Outcome plain = render(job, noise_scene);
        job.order_seed = 5;
        EXPECT_TRUE(same_bytes(plain.image, render(job, noise_scene).image)) << name;
        job.threads = 4;
        EXPECT_TRUE(same_bytes(plain.image, render(job, noise_scene).image)) << name;
        job.settings.bucket_x = 16; // buckets do not matter either
        job.settings.bucket_y = 32;
        EXPECT_TRUE(same_bytes(plain.image, render(job, noise_scene).image)) << name;
    }
}

TEST(Film, CropTilesAreTheWholePicture) {
    for (const auto& [name, width] : filters) {
        Job job{.filter = name,
                .wx = width,
                .wy = width,
                .settings = {.bucket_x = 8, .bucket_y = 8, .extra = {{}}}};
        const Outcome whole = render(job, noise_scene);
        const float cut_x = 0.37f, cut_y = 0.61f;
        std::size_t pixels = 0;
        for (const auto& crop : {std::array{0.0f, cut_x, 0.0f, cut_y},
                                 {cut_x, 1.0f, 0.0f, cut_y},
                                 {0.0f, cut_x, cut_y, 1.0f},
                                 {cut_x, 1.0f, cut_y, 1.0f}}) {
            job.crop = crop;
            const Image tile = render(job, noise_scene).image;
            pixels += tile.pixels.area();
            for (int y = tile.pixels.y0; y < tile.pixels.y1; ++y) {
                for (int x = tile.pixels.x0; x < tile.pixels.x1; ++x) {
                    const auto in_tile = static_cast<std::size_t>(
                        (y - tile.pixels.y0) * tile.pixels.width() + x - tile.pixels.x0);
                    const auto in_whole = static_cast<std::size_t>(y * job.xres + x);
                    for (std::size_t p = 0; p < tile.planes.size(); ++p) {
                        ASSERT_EQ(tile.planes[p][in_tile], whole.image.planes[p][in_whole]) << name;
                    }
                    ASSERT_EQ(tile.extra[0][in_tile], whole.image.extra[0][in_whole]) << name;
                }
            }
        }
        EXPECT_EQ(pixels, whole.image.pixels.area());
    }
}

// sum f s / sum f, from the filter itself in double.
TEST(Film, PixelIsTheWeightedMeanOfItsNeighbourhood) {
    Job job{.xres = 12, .yres = 11, .nx = 3, .ny = 2, .filter = "mitchell", .wx = 4, .wy = 3};
    const Image image = render(job, noise_scene).image;
    base::Diag diag;
    const trace::Filter filter("mitchell", 4, 3, diag);
    const trace::Sampler sampler({.nx = 3, .ny = 2});
    SampleBlock block;
    sampler.fill({-3, -3, 15, 14}, block);
    SampleBuffer samples;
    samples.samples.resize(block.count);
    for (std::size_t i = 0; i < block.count; ++i) {
        noise_scene(block, i, samples);
    }
    for (int y = 0; y < 11; ++y) {
        for (int x = 0; x < 12; ++x) {
            double sum = 0, total = 0;
            for (std::size_t i = 0; i < block.count; ++i) {
                const double w = filter.value(block.px[i] + double(block.x[i]) - x - 0.5,
                                              block.py[i] + double(block.y[i]) - y - 0.5);
                sum += w * double(samples.samples[i].color[2]);
                total += w;
            }
            // About 60 products of up to 2.5, rounded to float: 60 * 2.5 * 2^-24 at most.
            EXPECT_NEAR(image.plane(Plane::B)[static_cast<std::size_t>(y * 12 + x)], sum / total,
                        1e-5);
        }
    }
}

double largest_error(const Image& image, const std::function<double(int, int)>& expected) {
    double worst = 0;
    for (int y = image.pixels.y0; y < image.pixels.y1; ++y) {
        for (int x = image.pixels.x0; x < image.pixels.x1; ++x) {
            const auto i = static_cast<std::size_t>((y - image.pixels.y0) * image.pixels.width() +
                                                    x - image.pixels.x0);
            worst = std::max(worst, std::fabs(double(image.plane(Plane::A)[i]) - expected(x, y)));
        }
    }
    return worst;
}

// Area of a pixel below the line y = 3 + 0.3 x, by integrating the clamped height exactly enough.
double area_below_line(int px, int py) {
    double sum = 0;
    constexpr int steps = 2000;
    for (int i = 0; i < steps; ++i) {
        const double edge = 3 + 0.3 * (px + (i + 0.5) / steps);
        sum += std::clamp(py + 1 - edge, 0.0, 1.0);
    }
    return sum / steps;
}

TEST(Film, HalfPlaneCoverageConverges) {
    double before = 1;
    for (const int n : {2, 4, 8, 16, 32}) {
        Job job{.xres = 16, .yres = 16, .nx = n, .ny = n, .filter = "box", .wx = 1, .wy = 1};
        const double worst = largest_error(
            render(job, coverage([](double x, double y) { return y > 3 + 0.3 * x; })).image,
            area_below_line);
        // An edge crosses about n of n^2 cells, and each is wrong by less than a cell: at most
        // about 1.3 / n.
        EXPECT_LT(worst, 1.3 / n);
        EXPECT_LT(worst, before);
        before = worst;
    }
    EXPECT_LT(before, 2.0 / 255);
}

TEST(Film, DiscAreaConverges) {
    for (const char* name : {"box", "gaussian"}) {
        Job job{.xres = 32, .yres = 32, .nx = 16, .ny = 16, .filter = name, .wx = 2, .wy = 2};
        const Image image = render(job, coverage([](double x, double y) {
                                       return std::hypot(x - 16.3, y - 15.8) < 9.7;
                                   }))
                                .image;
        const auto alpha = image.plane(Plane::A);
        const double area = std::accumulate(alpha.begin(), alpha.end(), 0.0);
        // Filters conserve area inside the picture up to the normalisation of each pixel.
        EXPECT_NEAR(area, M_PI * 9.7 * 9.7, 0.1) << name;
    }
}

TEST(Film, DepthOfOwnSamples) {
    const Scene scene = [](const SampleBlock& b, std::size_t i, SampleBuffer& out) {
        if (b.px[i] > 0) { // pixel 0 is uncovered
            const std::size_t s = i % 4;
            out.samples[i].z = s == 3 ? trace::uncovered_z : static_cast<float>(s + 1);
            set_all(out.samples[i], 1);
        }
    };
    for (const auto& [depth, expected] : {std::pair{trace::DepthFilter::Min, 1.0f},
                                          {trace::DepthFilter::Max, 3.0f},
                                          {trace::DepthFilter::Average, 2.0f}}) {
        const Image image =
            render({.xres = 3, .yres = 1, .settings = {.depth = depth}}, scene).image;
        EXPECT_EQ(image.plane(Plane::Z)[0], trace::uncovered_z);
        EXPECT_EQ(image.plane(Plane::Z)[1], expected);
    }
}

TEST(Film, AlphaIsTheMeanOpacity) {
    const Image image =
        render({.xres = 2, .yres = 2}, [](const SampleBlock&, std::size_t i, SampleBuffer& out) {
            out.samples[i].opacity[0] = 1;
            out.samples[i].opacity[1] = 0.5f;
        }).image;
    EXPECT_EQ(image.plane(Plane::OR)[0], 1);
    EXPECT_FLOAT_EQ(image.plane(Plane::OG)[0], 0.5f);
    EXPECT_EQ(image.plane(Plane::OB)[0], 0);
    EXPECT_FLOAT_EQ(image.plane(Plane::A)[0], 0.5f);
}

TEST(Film, SamplesThatAreNotNumbersAreReplacedAndCounted) {
    const Outcome out = render({.xres = 6, .yres = 6},
                               [](const SampleBlock& b, std::size_t i, SampleBuffer& buffer) {
                                   set_all(buffer.samples[i], 1);
                                   buffer.samples[i].z = 1;
                                   if (b.px[i] == 3 && b.py[i] == 3 && i % 4 == 0) {
                                       buffer.samples[i].color[1] = NAN;
                                       buffer.samples[i].z = NAN;
                                   }
                                   if (b.px[i] == 3 && b.py[i] == 3 && i % 4 == 1) {
                                       buffer.samples[i].opacity[2] = -INFINITY;
                                   }
                               });
    EXPECT_EQ(out.bad, 2U);
    for (const auto& plane : out.image.planes) {
        EXPECT_TRUE(std::ranges::all_of(plane, [](float v) { return std::isfinite(v); }));
    }
}

TEST(Film, StripBesideThePictureStaysEmpty) {
    const Outcome out = render(
        {.xres = 20, .yres = 10, .frame_aspect = 1},
        [](const SampleBlock&, std::size_t i, SampleBuffer& b) { set_all(b.samples[i], 1); });
    EXPECT_EQ(out.image.pixels.width(), 20);
    EXPECT_EQ(out.image.plane(Plane::A)[9], 1);
    EXPECT_EQ(out.image.plane(Plane::A)[10], 0);
    EXPECT_EQ(out.image.plane(Plane::Z)[10], trace::uncovered_z);
}

TEST(Film, EmptyCropIsCompleteAtOnce) {
    const Outcome out = render({.crop = {0.5f, 0.5f, 0, 1}}, noise_scene);
    EXPECT_EQ(out.buckets, 0U);
    EXPECT_TRUE(out.image.pixels.empty());
}

TEST(Film, SampleMemoryIsReleased) {
    const Outcome out = render({.xres = 64, .yres = 640}, noise_scene);
    // In row order at most two rows of buckets and one bucket wait: 40 rows hold them all.
    EXPECT_LT(out.peak_bytes, 66U * 642 * 4 * 36 / 10);
}

TEST(Film, RefusesPicturesBeyondMemory) {
    std::FILE* null = std::fopen("/dev/null", "w");
    base::Diag diag(null);
    rib::Options o;
    o.xres = o.yres = 65536;
    const trace::Sampler sampler({});
    const trace::FilterWeights weights(trace::Filter("box", 1, 1, diag), sampler);
    EXPECT_EQ(Film::create(trace::make_raster(o, diag), sampler, weights, {}, diag), nullptr);
    EXPECT_EQ(diag.last_code(), base::Code::NoMem);
    std::fclose(null);
}

TEST(Film, SettingsFromOptions) {
    std::FILE* null = std::fopen("/dev/null", "w");
    base::Diag diag(null);
    rib::Options o;
    rib::Param size;
    size.ints = {100000, 1};
    o.user["limits:bucketsize"] = size;
    rib::Param depth;
    depth.name = "depthfilter";
    depth.decl.type = rib::ParamType::String;
    depth.strings = {"max"};
    o.hider_params.params.push_back(depth);
    trace::FilmSettings s = trace::film_settings(o, diag);
    EXPECT_EQ(s.bucket_x, 256);
    EXPECT_EQ(s.bucket_y, 4);
    EXPECT_EQ(s.depth, trace::DepthFilter::Max);
    o.hider_params.params[0].strings = {"midpoint"};
    s = trace::film_settings(o, diag);
    EXPECT_EQ(s.depth, trace::DepthFilter::Min);
    EXPECT_EQ(diag.count(base::Severity::Warning), 1U);
    std::fclose(null);
}

} // namespace
