// SPDX-License-Identifier: Apache-2.0
#include "tracer/live_view.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <new>
#include <utility>

namespace trace {

namespace {

constexpr std::size_t channels = 4;

double steady_seconds() {
    using namespace std::chrono;
    return duration<double>(steady_clock::now().time_since_epoch()).count();
}

// Pixels of a picture, exposed if they were not.
std::vector<float> tile_of(const Image& image, const PixelRange& pixels, const Exposer* exposer) {
    std::vector<float> out;
    out.reserve(pixels.area() * channels);
    const auto exposed = [&](float c) { return exposer != nullptr ? (*exposer)(c) : c; };
    for (int y = pixels.y0; y < pixels.y1; ++y) {
        const auto row = static_cast<std::size_t>(y - image.pixels.y0) *
                         static_cast<std::size_t>(image.pixels.width());
        for (int x = pixels.x0; x < pixels.x1; ++x) {
            const std::size_t i = row + static_cast<std::size_t>(x - image.pixels.x0);
            for (const Plane p : {Plane::R, Plane::G, Plane::B}) {
                out.push_back(exposed(image.plane(p)[i]));
            }
            out.push_back(image.plane(Plane::A)[i]);
        }
    }
    return out;
}

float finite(float value) {
    return std::isfinite(value) ? value : 0;
}

// The plain mean of each pixel's own samples: what there is before neighbours allow filtering.
std::vector<float> tile_of(const SampleBuffer& samples, const PixelRange& pixels,
                           const Exposer& exposed) {
    std::vector<float> out;
    out.reserve(pixels.area() * channels);
    for (int y = pixels.y0; y < pixels.y1; ++y) {
        for (int x = pixels.x0; x < pixels.x1; ++x) {
            const auto [first, count] = samples.part(x, y);
            float sum[channels] = {};
            for (std::size_t s = first; s < first + count; ++s) {
                const Sample& sample = samples.samples[s];
                for (std::size_t c = 0; c < 3; ++c) {
                    sum[c] += finite(sample.color[c]);
                    sum[3] += finite(sample.opacity[c]);
                }
            }
            const float weight = 1 / static_cast<float>(count);
            for (std::size_t c = 0; c < channels; ++c) {
                out.push_back(c < 3 ? exposed(sum[c] * weight) : sum[c] / 3 * weight);
            }
        }
    }
    return out;
}

} // namespace

LiveView::LiveView(Clock clock) : clock_(clock != nullptr ? clock : steady_seconds) {}

// --- the renderer's side

bool LiveView::begin_frame(const LiveFrame& frame, std::size_t num_buckets) {
    if (frame.pixels.area() > max_live_pixels) {
        return false;
    }
    const std::lock_guard lock(mutex_);
    try {
        rgba_.assign(frame.pixels.area() * channels, 0.0f);
        tiles_.assign(num_buckets, {});
        changes_.clear();
        changes_.reserve(2 * num_buckets);
    } catch (const std::bad_alloc&) {
        rgba_ = {};
        return false;
    }
    frame_ = frame;
    state_ = LiveState::Rendering;
    ++serial_;
    ++status_;
    num_known_ = 0;
    start_s_ = clock_();
    changed_.notify_all();
    return true;
}

float* LiveView::pixel(int x, int y) {
    return const_cast<float*>(std::as_const(*this).pixel(x, y));
}

const float* LiveView::pixel(int x, int y) const {
    const auto width = static_cast<std::size_t>(frame_.pixels.width());
    return rgba_.data() + (static_cast<std::size_t>(y - frame_.pixels.y0) * width +
                           static_cast<std::size_t>(x - frame_.pixels.x0)) *
                              channels;
}

void LiveView::put(std::size_t bucket, const PixelRange& pixels, bool final,
                   const std::vector<float>& rgba) {
    const auto row = static_cast<std::size_t>(pixels.width()) * channels;
    Tile& tile = tiles_[bucket];
    bool same = tile.pixels == pixels && tile.final == final;
    for (int y = pixels.y0; y < pixels.y1; ++y) {
        const float* from = rgba.data() + static_cast<std::size_t>(y - pixels.y0) * row;
        float* to = pixel(pixels.x0, y);
        same = same && std::equal(from, from + row, to);
        std::copy_n(from, row, to);
    }
    if (same) {
        return;
    }
    num_known_ += tile.pixels.empty() ? 1 : 0;
    changes_.push_back(static_cast<std::uint32_t>(bucket));
    tile = {pixels, static_cast<std::uint32_t>(changes_.size()), final};
    changed_.notify_all();
}

void LiveView::samples_in(std::size_t bucket, const PixelRange& pixels,
                          const SampleBuffer& samples) {
    // frame_ does not change while the film works.
    const std::vector<float> rgba = tile_of(samples, pixels, Exposer(frame_.exposure));
    const std::lock_guard lock(mutex_);
    if (!tiles_[bucket].final) { // an earlier run may have finished it
        put(bucket, pixels, false, rgba);
    }
}

void LiveView::bucket_done(std::size_t bucket, const PixelRange& pixels, const Image& image) {
    const Exposer exposer(frame_.exposure);
    const std::vector<float> rgba = tile_of(image, pixels, &exposer);
    const std::lock_guard lock(mutex_);
    put(bucket, pixels, true, rgba);
}

void LiveView::show_final(const Image& developed) {
    for (std::size_t i = 0; i < tiles_.size(); ++i) { // only this thread changes them now
        const PixelRange pixels = tiles_[i].pixels.intersected(developed.pixels);
        if (!pixels.empty()) {
            const std::vector<float> rgba = tile_of(developed, pixels, nullptr);
            const std::lock_guard lock(mutex_);
            put(i, pixels, true, rgba);
        }
    }
}

void LiveView::end_frame(LiveState state) {
    const std::lock_guard lock(mutex_);
    state_ = state;
    end_s_ = clock_();
    ++status_;
    changed_.notify_all();
}

void LiveView::close() {
    const std::lock_guard lock(mutex_);
    closing_ = true;
    ++status_;
    changed_.notify_all();
}

// --- readers

LiveMark LiveView::newest_locked() const {
    return {serial_, static_cast<std::uint32_t>(changes_.size()), status_};
}

LiveMark LiveView::newest() const {
    const std::lock_guard lock(mutex_);
    return newest_locked();
}

bool LiveView::closing() const {
    const std::lock_guard lock(mutex_);
    return closing_;
}

bool LiveView::wait(const LiveMark& since, double timeout_s) const {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, std::chrono::duration<double>(timeout_s),
                             [&] { return !(newest_locked() == since); });
}

LiveUpdate LiveView::status_locked() const {
    LiveUpdate update;
    update.frame = frame_;
    update.state = state_;
    update.closing = closing_;
    update.num_done = num_known_;
    update.num_buckets = tiles_.size();
    if (state_ == LiveState::Rendering) {
        update.elapsed_s = clock_() - start_s_;
        if (num_known_ > 0) {
            update.left_s = update.elapsed_s *
                            static_cast<double>(update.num_buckets - num_known_) /
                            static_cast<double>(num_known_);
        }
    } else if (state_ != LiveState::Waiting) {
        update.elapsed_s = end_s_ - start_s_;
    }
    return update;
}

// Buckets that changed since the mark, oldest change first, each once; mark moves behind them.
std::vector<std::uint32_t> LiveView::changed_locked(const LiveMark& since, std::size_t max_pixels,
                                                    LiveMark& mark) const {
    std::vector<std::uint32_t> buckets;
    std::size_t num_pixels = 0;
    std::uint32_t at = since.frame == serial_ ? since.change : 0;
    for (; at < changes_.size() && num_pixels < max_pixels; ++at) {
        const std::uint32_t bucket = changes_[at];
        if (tiles_[bucket].last_change == at + 1) {
            buckets.push_back(bucket);
            num_pixels += tiles_[bucket].pixels.area();
        }
    }
    mark = {serial_, at, status_};
    return buckets;
}

LiveUpdate LiveView::read(const LiveMark& since, std::size_t max_pixels) const {
    std::vector<std::uint32_t> buckets;
    LiveUpdate update;
    {
        const std::lock_guard lock(mutex_);
        update = status_locked();
        update.restart = since.frame != serial_;
        buckets = changed_locked(since, max_pixels, update.mark);
    }
    for (const std::uint32_t bucket : buckets) {
        const std::lock_guard lock(mutex_); // one bucket at a time: renderer threads go between
        if (serial_ != update.mark.frame) {
            break; // a new frame began: the next read starts it
        }
        LiveTile tile{tiles_[bucket].pixels, tiles_[bucket].final, {}};
        tile.rgba.reserve(tile.pixels.area() * channels);
        for (int y = tile.pixels.y0; y < tile.pixels.y1; ++y) {
            const float* row = pixel(tile.pixels.x0, y);
            tile.rgba.insert(tile.rgba.end(), row,
                             row + static_cast<std::size_t>(tile.pixels.width()) * channels);
        }
        update.tiles.push_back(std::move(tile));
    }
    return update;
}

} // namespace trace
