// SPDX-License-Identifier: Apache-2.0
#include "tracer/film.h"

#include "tracer/gather.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <new>
#include <string>
#include <unistd.h>

namespace trace {

namespace {

constexpr int min_bucket_px = 4;
constexpr std::size_t max_pixels = std::size_t{1} << 28;
constexpr std::size_t max_bucket_samples = std::size_t{1} << 20;

std::size_t physical_bytes() {
    const long pages = ::sysconf(_SC_PHYS_PAGES), size = ::sysconf(_SC_PAGE_SIZE);
    return pages > 0 && size > 0 ? static_cast<std::size_t>(pages) * static_cast<std::size_t>(size)
                                 : std::numeric_limits<std::size_t>::max();
}

} // namespace

// --- image

std::vector<std::span<float>> Image::all_planes() {
    std::vector<std::span<float>> all(planes.begin(), planes.end());
    all.insert(all.end(), extra.begin(), extra.end());
    return all;
}

std::vector<std::span<const float>> Image::all_planes() const {
    std::vector<std::span<const float>> all(planes.begin(), planes.end());
    all.insert(all.end(), extra.begin(), extra.end());
    return all;
}

// --- settings

DepthFilter depth_filter(const rib::Options& options, base::Diag& diag) {
    const std::string name = options.hider_params.get_string("depthfilter", "min");
    if (name == "min") {
        return DepthFilter::Min;
    }
    if (name == "max") {
        return DepthFilter::Max;
    }
    if (name == "average") {
        return DepthFilter::Average;
    }
    diag.report_once("depthfilter", base::Severity::Warning, base::Code::Unimplement, {},
                     "Hider: depthfilter \"" + name +
                         "\" is not known (min, max, average are); using min");
    return DepthFilter::Min;
}

FilmSettings film_settings(const rib::Options& options, base::Diag& diag) {
    FilmSettings s;
    const auto it = options.user.find("limits:bucketsize");
    if (it != options.user.end() && it->second.ints.size() >= 2) {
        s.bucket_x = std::clamp(it->second.ints[0], min_bucket_px, max_bucket_px);
        s.bucket_y = std::clamp(it->second.ints[1], min_bucket_px, max_bucket_px);
    }
    s.depth = depth_filter(options, diag);
    return s;
}

// --- buckets

struct Film::Bucket {
    PixelRange output; // pixels it computes
    PixelRange owned;  // pixels whose samples it holds: output and what lies beyond the border
    SampleBuffer samples;
    std::size_t missing = 0; // buckets of the neighbourhood without samples yet
    std::size_t users = 0;   // buckets of the neighbourhood not filtered yet
    bool restored = false;
};

std::unique_ptr<Film> Film::create(const Raster& raster, const Sampler& sampler,
                                   const FilterWeights& weights, const FilmSettings& settings,
                                   base::Diag& diag) {
    const std::size_t planes = static_cast<std::size_t>(Plane::Count) + settings.extra.size();
    const std::size_t bytes = raster.crop.area() * planes * sizeof(float);
    if (raster.crop.area() <= max_pixels && bytes < physical_bytes()) {
        try {
            return std::unique_ptr<Film>(new Film(raster, sampler, weights, settings));
        } catch (const std::bad_alloc&) { // reported below
        }
    }
    diag.report(base::Severity::Severe, base::Code::NoMem, {},
                "not enough memory for a picture of " + std::to_string(raster.crop.width()) +
                    " by " + std::to_string(raster.crop.height()) + " pixels (" +
                    std::to_string(bytes >> 20) + " MB); nothing was rendered");
    return nullptr;
}

Film::Film(const Raster& raster, const Sampler& sampler, const FilterWeights& weights,
           const FilmSettings& settings)
    : sampler_(sampler), weights_(weights), settings_(settings), picture_(raster.picture) {
    // Many samples per pixel, or many channels, make buckets smaller, so that their memory stays
    // bounded.
    const std::size_t per_pixel = static_cast<std::size_t>(sampler.per_pixel()) *
                                  (1 + settings_.extra.size() * sizeof(float) / sizeof(Sample));
    const auto samples = [&] {
        return static_cast<std::size_t>(settings_.bucket_x) *
               static_cast<std::size_t>(settings_.bucket_y) * per_pixel;
    };
    while (samples() > max_bucket_samples && settings_.bucket_x * settings_.bucket_y > 1) {
        int& larger =
            settings_.bucket_x > settings_.bucket_y ? settings_.bucket_x : settings_.bucket_y;
        larger = (larger + 1) / 2;
    }
    image_.pixels = raster.crop;
    for (auto& plane : image_.planes) {
        plane.assign(raster.crop.area(), 0.0f);
    }
    std::ranges::fill(image_.plane(Plane::Z), uncovered_z);
    reach_x_ = weights.reach_x();
    reach_y_ = weights.reach_y();
    for (const ExtraChannel& c : settings_.extra) {
        image_.extra.emplace_back(raster.crop.area(), c.empty);
        if (c.weights != nullptr) {
            reach_x_ = std::max(reach_x_, c.weights->reach_x());
            reach_y_ = std::max(reach_y_, c.weights->reach_y());
        }
    }
    near_x_ = (reach_x_ + settings_.bucket_x - 1) / settings_.bucket_x;
    near_y_ = (reach_y_ + settings_.bucket_y - 1) / settings_.bucket_y;
    make_buckets(raster.rendered());
}

Film::~Film() = default;

namespace {

// Cuts begin..end at the multiples of size.
std::vector<int> cuts(int begin, int end, int size) {
    std::vector<int> at = {begin};
    for (int next = (begin / size + 1) * size; next < end; next += size) {
        at.push_back(next);
    }
    at.push_back(end);
    return at;
}

} // namespace

void Film::make_buckets(const PixelRange& rendered) {
    if (rendered.empty()) {
        return;
    }
    const auto xs = cuts(rendered.x0, rendered.x1, settings_.bucket_x);
    const auto ys = cuts(rendered.y0, rendered.y1, settings_.bucket_y);
    columns_ = static_cast<int>(xs.size()) - 1;
    rows_ = static_cast<int>(ys.size()) - 1;
    for (std::size_t j = 0; j + 1 < ys.size(); ++j) {
        for (std::size_t i = 0; i + 1 < xs.size(); ++i) {
            Bucket b;
            b.output = {xs[i], ys[j], xs[i + 1], ys[j + 1]};
            b.owned = b.output;
            b.owned.x0 -= i == 0 ? reach_x_ : 0;
            b.owned.y0 -= j == 0 ? reach_y_ : 0;
            b.owned.x1 += i + 2 == xs.size() ? reach_x_ : 0;
            b.owned.y1 += j + 2 == ys.size() ? reach_y_ : 0;
            buckets_.push_back(std::move(b));
        }
    }
    for (std::size_t i = 0; i < buckets_.size(); ++i) {
        buckets_[i].missing = buckets_[i].users = neighbours(i).size();
    }
}

// The buckets whose samples this one needs, itself included; the relation is symmetric.
std::vector<std::size_t> Film::neighbours(std::size_t bucket) const {
    const int column = static_cast<int>(bucket) % columns_,
              row = static_cast<int>(bucket) / columns_;
    std::vector<std::size_t> out;
    for (int j = std::max(row - near_y_, 0); j <= std::min(row + near_y_, rows_ - 1); ++j) {
        for (int i = std::max(column - near_x_, 0); i <= std::min(column + near_x_, columns_ - 1);
             ++i) {
            out.push_back(static_cast<std::size_t>(j * columns_ + i));
        }
    }
    return out;
}

std::size_t Film::num_buckets() const {
    return buckets_.size();
}

PixelRange Film::sample_pixels(std::size_t bucket) const {
    return buckets_[bucket].owned;
}

// What lies farther beyond the edges of the picture than filters reach is nobody's.
PixelRange Film::tile_pixels(std::size_t bucket) const {
    return whole_tiles(buckets_[bucket].owned).intersected(picture_.grown(reach_x_, reach_y_));
}

PixelRange Film::output_pixels(std::size_t bucket) const {
    return buckets_[bucket].output;
}

std::size_t Film::peak_bytes() const {
    const std::lock_guard lock(mutex_);
    return bytes_peak_;
}

bool Film::complete() const {
    const std::lock_guard lock(mutex_);
    return num_done_ == buckets_.size();
}

// --- samples

SampleBuffer Film::buffer(std::size_t bucket, std::span<const std::uint16_t> counts) {
    SampleBuffer out;
    {
        const std::lock_guard lock(mutex_);
        if (!pool_.empty()) {
            out = std::move(pool_.back());
            pool_.pop_back();
        }
    }
    out.pixels = buckets_[bucket].owned;
    out.num_extra = static_cast<int>(settings_.extra.size());
    std::size_t n = out.pixels.area() * static_cast<std::size_t>(sampler_.per_pixel());
    out.begins.clear();
    if (!counts.empty()) {
        assert(counts.size() == out.pixels.area() * quarters);
        out.begins.push_back(0);
        for (const std::uint16_t count : counts) {
            out.begins.push_back(out.begins.back() + count);
        }
        n = out.begins.back();
    }
    out.samples.assign(n, Sample{});
    out.extra.assign(n * settings_.extra.size(), 0.0f);
    return out;
}

namespace {

std::size_t bytes_of(const SampleBuffer& b) {
    return b.samples.size() * sizeof(Sample) + b.extra.size() * sizeof(float);
}

} // namespace

void Film::submit(std::size_t bucket, SampleBuffer&& samples) {
    assert(samples.pixels == buckets_[bucket].owned);
    for (FilmObserver* observer : observers_) {
        observer->samples_in(bucket, buckets_[bucket].output, samples);
    }
    const auto near = neighbours(bucket);
    std::vector<std::size_t> ready;
    {
        const std::lock_guard lock(mutex_);
        bytes_held_ += bytes_of(samples);
        bytes_peak_ = std::max(bytes_peak_, bytes_held_);
        buckets_[bucket].samples = std::move(samples);
        for (const std::size_t n : near) {
            if (--buckets_[n].missing == 0 && !buckets_[n].restored) {
                ready.push_back(n);
            }
        }
    }
    for (const std::size_t n : ready) {
        filter_bucket(n);
        release(n);
    }
}

// --- buckets of an earlier run

bool Film::restore(std::size_t bucket, std::span<const float> values) {
    if (bucket >= buckets_.size() || buckets_[bucket].restored ||
        values.size() != buckets_[bucket].output.area() * num_planes()) {
        return false;
    }
    buckets_[bucket].restored = true;
    const PixelRange& output = buckets_[bucket].output;
    const auto width = static_cast<std::size_t>(output.width());
    for (const std::span<float> plane : image_.all_planes()) {
        for (int y = output.y0; y < output.y1; ++y, values = values.subspan(width)) {
            std::ranges::copy(values.first(width), plane.begin() + image_.index(output.x0, y));
        }
    }
    release(bucket);
    for (FilmObserver* observer : observers_) {
        observer->bucket_done(bucket, output, image_);
    }
    return true;
}

bool Film::needs_samples(std::size_t bucket) const {
    const std::lock_guard lock(mutex_);
    return buckets_[bucket].users > 0;
}

// One bucket less needs the samples of its neighbourhood.
void Film::release(std::size_t bucket) {
    const std::lock_guard lock(mutex_);
    ++num_done_;
    for (const std::size_t n : neighbours(bucket)) {
        if (--buckets_[n].users == 0) {
            bytes_held_ -= bytes_of(buckets_[n].samples);
            if (!buckets_[n].samples.samples.empty()) {
                pool_.push_back(std::move(buckets_[n].samples));
            }
            buckets_[n].samples = {};
        }
    }
}

void Film::filter_bucket(std::size_t bucket) {
    Gather gather(sampler_, weights_, settings_.extra, settings_.depth, buckets_[bucket].output);
    for (const std::size_t n : neighbours(bucket)) {
        gather.add(buckets_[n].samples);
    }
    num_bad_ += gather.run(image_);
    for (FilmObserver* observer : observers_) {
        observer->bucket_done(bucket, buckets_[bucket].output, image_);
    }
}

} // namespace trace
