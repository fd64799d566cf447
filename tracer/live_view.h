// SPDX-License-Identifier: Apache-2.0
// The picture as far as it is known, for viewers that look while it is rendered.
//
// In: finished buckets of the film (FilmObserver), at the end the picture that the display got.
// Out: what changed since a reader last asked. Renderer threads copy one bucket under a lock and go
// on; readers copy bucket by bucket, so nobody waits for a viewer, however slow. Decisions:
// live-001, live-002.
#pragma once

#include "tracer/film.h"
#include "tracer/quantize.h"

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

namespace trace {

// What is shown, told at the start of a frame.
struct LiveFrame {
    std::string name;  // of the picture
    int number = 0;    // of the frame
    PixelRange pixels; // of the whole frame's raster
    Exposure exposure;
    Quantizer color, alpha; // of the display; Float: shown with the sRGB curve
};

enum class LiveState : std::uint8_t {
    Waiting,   // no frame yet
    Rendering, // buckets arrive
    Done,      // the frame's picture is complete; another frame may follow
    Stopped    // interrupted: it stays as it is
};

// Where a reader stands; the default has seen nothing.
struct LiveMark {
    std::uint32_t frame = 0;  // serial number, from 1
    std::uint32_t change = 0; // of buckets in the frame
    std::uint32_t status = 0; // of the state
    friend bool operator==(const LiveMark&, const LiveMark&) = default;
};

struct LiveTile {
    PixelRange pixels;
    bool final = false;      // no more filtering to come
    std::vector<float> rgba; // exposed, color premultiplied
};

struct LiveUpdate {
    LiveFrame frame;
    LiveState state = LiveState::Waiting;
    bool closing = false; // the program ends; nothing follows
    std::size_t num_done = 0, num_buckets = 0;
    double elapsed_s = 0, left_s = -1; // -1: not known
    bool restart = false;              // tiles are of another frame than the reader's mark
    std::vector<LiveTile> tiles;
    LiveMark mark; // to ask with next
};

class LiveView : public FilmObserver {
public:
    using Clock = double (*)(); // seconds
    explicit LiveView(Clock clock = nullptr);

    // --- the renderer's side; one frame at a time
    // False: not enough memory; the frame is not shown.
    bool begin_frame(const LiveFrame& frame, std::size_t num_buckets);
    void samples_in(std::size_t bucket, const PixelRange& pixels,
                    const SampleBuffer& samples) override;
    void bucket_done(std::size_t bucket, const PixelRange& pixels, const Image& image) override;
    // The developed picture, where it differs from the buckets (imager).
    void show_final(const Image& developed);
    void end_frame(LiveState state);
    // The program ends: readers wake and are told so.
    void close();

    // --- readers, any number, each with its own mark
    // What changed, at most about max_pixels of it; the rest is there at once when asked again.
    [[nodiscard]] LiveUpdate read(const LiveMark& since, std::size_t max_pixels) const;
    // Until something changed; false after timeout_s.
    bool wait(const LiveMark& since, double timeout_s) const;
    [[nodiscard]] LiveMark newest() const;
    [[nodiscard]] bool closing() const;

private:
    struct Tile {
        PixelRange pixels; // empty: nothing there yet
        std::uint32_t last_change = 0;
        bool final = false;
    };
    [[nodiscard]] LiveMark newest_locked() const;
    [[nodiscard]] LiveUpdate status_locked() const;
    [[nodiscard]] std::vector<std::uint32_t>
    changed_locked(const LiveMark& since, std::size_t max_pixels, LiveMark& mark) const;
    void put(std::size_t bucket, const PixelRange& pixels, bool final,
             const std::vector<float>& rgba);
    [[nodiscard]] float* pixel(int x, int y);
    [[nodiscard]] const float* pixel(int x, int y) const;

    Clock clock_;
    mutable std::mutex mutex_; // guards all below
    mutable std::condition_variable changed_;
    LiveFrame frame_;
    LiveState state_ = LiveState::Waiting;
    bool closing_ = false;
    std::uint32_t serial_ = 0, status_ = 0;
    std::size_t num_known_ = 0; // tiles that are not empty
    double start_s_ = 0, end_s_ = 0;
    std::vector<float> rgba_;            // of frame_.pixels
    std::vector<Tile> tiles_;            // by bucket
    std::vector<std::uint32_t> changes_; // buckets in the order they changed
};

// Pictures beyond this are not shown: 1 GB of floats here, more in a browser.
constexpr std::size_t max_live_pixels = std::size_t{1} << 26;

} // namespace trace
