// SPDX-License-Identifier: Apache-2.0
// Keeps the finished buckets of a frame on disk while it renders, and takes them back with
// --resume: the picture gets the same bytes as without the interruption (trace-010).
//
// Threads that finish buckets only note their numbers; a thread of its own copies the pixels, which
// do not change any more, and writes them. Nothing is written for frames shorter than `after_s`.
// Trouble with the file is one warning; rendering goes on.
#pragma once

#include "runtime/base/diag.h"
#include "tracer/checkpoint_file.h"
#include "tracer/film.h"

#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace trace {

struct CheckpointSettings {
    bool enabled = true;
    double after_s = 10;   // time of rendering from which on buckets are kept
    std::string directory; // "" = beside the picture
    bool resume = false;
};

// Where the checkpoint of a picture is kept.
[[nodiscard]] std::string checkpoint_path(const std::string& picture, const std::string& directory);

class Checkpoint final : public FilmObserver {
public:
    // path: see checkpoint_path(); "" = there is nothing to keep. frame_hash identifies all that
    // decides the pixels; it is called at most once, from any thread.
    using Hash = std::array<std::uint8_t, 32>;
    Checkpoint(const CheckpointSettings& settings, std::string path,
               std::function<Hash()> frame_hash, base::Diag& diag);
    ~Checkpoint() override;
    Checkpoint(const Checkpoint&) = delete;
    Checkpoint& operator=(const Checkpoint&) = delete;

    // Before the first bucket. The film outlives finish().
    void start(Film& film);
    void bucket_done(std::size_t bucket, const PixelRange& pixels, const Image& image) override;
    // After the last one: what is finished is on disk, if anything is. The film is not used again.
    void finish();

    // The pictures are written: there is nothing to resume.
    void remove();
    // Tells the user what was kept of a frame that did not get its pictures.
    void report_kept() const;

private:
    struct Done {
        std::size_t bucket;
        PixelRange pixels;
    };
    void resume(Film& film);
    void run();
    void write(const std::vector<Done>& done, bool to_disk);
    void give_up(int error);
    [[nodiscard]] CheckpointKey key();

    CheckpointSettings settings_;
    std::string path_;
    std::function<Hash()> frame_hash_;
    base::Diag& diag_;
    CheckpointKey key_;
    bool has_key_ = false;

    // The writer's own, once it runs.
    CheckpointFile file_;
    bool given_up_ = false;
    std::size_t num_kept_ = 0;
    const Image* image_ = nullptr;
    std::vector<float> values_;

    std::mutex mutex_; // guards what follows
    std::condition_variable wake_;
    std::vector<Done> done_;
    bool stop_ = false;
    std::thread writer_;
};

} // namespace trace
