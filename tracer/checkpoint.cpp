// SPDX-License-Identifier: Apache-2.0
#include "tracer/checkpoint.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <new>
#include <system_error>

namespace trace {

namespace {

using Seconds = std::chrono::duration<double>;
using Clock = std::chrono::steady_clock;

// Between writes: what a killed process loses. And between syncs: what a dying machine loses.
constexpr Seconds write_interval{0.25};
constexpr Seconds sync_interval{30};
constexpr double longest_s = 1e8; // three years; clocks overflow later

} // namespace

std::string checkpoint_path(const std::string& picture, const std::string& directory) {
    if (picture.empty()) {
        return "";
    }
    std::string name = picture + ".perigee-checkpoint";
    if (directory.empty()) {
        return name;
    }
    std::ranges::replace(name, '/', '%'); // pictures of all directories share this one
    return directory + "/" + name;
}

Checkpoint::Checkpoint(const CheckpointSettings& settings, std::string path,
                       std::function<Hash()> frame_hash, base::Diag& diag)
    : settings_(settings), path_(std::move(path)), frame_hash_(std::move(frame_hash)), diag_(diag) {
    settings_.enabled = settings_.enabled && !path_.empty();
    settings_.after_s = std::clamp(settings_.after_s, 0.0, longest_s);
}

Checkpoint::~Checkpoint() {
    finish();
}

CheckpointKey Checkpoint::key() {
    if (!has_key_) {
        key_.frame = frame_hash_();
        has_key_ = true;
    }
    return key_;
}

void Checkpoint::start(Film& film) {
    if (!settings_.enabled) {
        return;
    }
    key_.num_buckets = static_cast<std::uint32_t>(film.num_buckets());
    key_.num_planes = static_cast<std::uint32_t>(film.num_planes());
    image_ = &film.image();
    if (settings_.resume) {
        resume(film);
    } else if (is_checkpoint(path_)) {
        diag_.report(base::Severity::Info, base::Code::None, {},
                     path_ + " holds buckets of an earlier run; --resume would go on from there");
    }
    if (given_up_) {
        return;
    }
    film.add_observer(*this);
    try {
        writer_ = std::thread([this] { run(); });
    } catch (const std::system_error& e) {
        give_up(e.code().value());
    }
}

void Checkpoint::resume(Film& film) {
    const auto take = [&](std::size_t bucket, std::span<const float> values) {
        num_kept_ += film.restore(bucket, values) ? 1 : 0;
    };
    const auto say = [&](base::Severity severity, const std::string& text) {
        diag_.report(severity, base::Code::None, {}, path_ + text);
    };
    switch (file_.resume(path_, key(), take)) {
    case CheckpointFile::Resumed::Yes:
        say(base::Severity::Info, ": " + std::to_string(num_kept_) + " of " +
                                      std::to_string(film.num_buckets()) +
                                      " buckets are taken from there");
        return;
    case CheckpointFile::Resumed::Missing:
        say(base::Severity::Info, " does not exist; the frame is rendered from the beginning");
        return;
    case CheckpointFile::Resumed::Foreign:
        say(base::Severity::Warning,
            " does not belong to this frame (another scene, other options or shaders, or another "
            "version), or is damaged; the frame is rendered from the beginning");
        return;
    case CheckpointFile::Resumed::Busy:
    case CheckpointFile::Resumed::Failed:
        give_up(file_.error());
        return;
    }
}

void Checkpoint::bucket_done(std::size_t bucket, const PixelRange& pixels, const Image&) {
    const std::lock_guard lock(mutex_);
    done_.push_back({bucket, pixels});
}

// The writer thread.
void Checkpoint::run() {
    const Clock::time_point started = Clock::now();
    std::unique_lock lock(mutex_);
    if (!file_.is_open()) {
        wake_.wait_for(lock, Seconds(settings_.after_s), [this] { return stop_; });
        if (Clock::now() - started < Seconds(settings_.after_s)) {
            return; // too short to be worth a file
        }
    }
    Clock::time_point synced = Clock::now();
    for (bool last = false; !last && !given_up_;) {
        last = stop_;
        std::vector<Done> done;
        done.swap(done_);
        lock.unlock();
        const bool to_disk = last || Clock::now() - synced > sync_interval;
        try {
            write(done, to_disk);
        } catch (const std::bad_alloc&) {
            give_up(ENOMEM);
        }
        synced = to_disk ? Clock::now() : synced;
        lock.lock();
        if (!last) {
            wake_.wait_for(lock, write_interval, [this] { return stop_; });
        }
    }
}

void Checkpoint::write(const std::vector<Done>& done, bool to_disk) {
    if (!file_.is_open() && !file_.create(path_, key())) {
        give_up(file_.error());
        return;
    }
    bool ok = true;
    for (const Done& bucket : done) {
        values_.clear();
        for (const std::span<const float> plane : image_->all_planes()) {
            for (int y = bucket.pixels.y0; y < bucket.pixels.y1; ++y) {
                const auto row = plane.begin() + image_->index(bucket.pixels.x0, y);
                values_.insert(values_.end(), row, row + bucket.pixels.width());
            }
        }
        ok = ok && file_.append(bucket.bucket, values_);
    }
    if (ok && (to_disk ? file_.sync() : file_.flush())) {
        num_kept_ += done.size();
    } else {
        give_up(file_.error());
    }
}

void Checkpoint::give_up(int error) {
    given_up_ = true;
    const std::string why =
        error == EWOULDBLOCK ? std::string("another render has it open") : std::strerror(error);
    diag_.report(base::Severity::Warning, base::Code::System, {},
                 "checkpoint " + path_ + ": " + why +
                     "; rendering goes on, but buckets are not kept any more");
}

void Checkpoint::finish() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    wake_.notify_all();
    if (writer_.joinable()) {
        writer_.join();
    }
}

void Checkpoint::remove() {
    if (file_.is_open()) {
        file_.remove();
    } else if (settings_.enabled) {
        remove_stale_checkpoint(path_);
    }
}

void Checkpoint::report_kept() const {
    if (!settings_.enabled || image_ == nullptr) { // or not begun
        return;
    }
    const std::string text = file_.is_open()
                                 ? std::to_string(num_kept_) + " of " +
                                       std::to_string(key_.num_buckets) + " buckets are kept in " +
                                       path_ + "; the same command with --resume goes on from there"
                                 : "no bucket was kept";
    diag_.report(base::Severity::Info, base::Code::None, {}, text);
}

} // namespace trace
