// SPDX-License-Identifier: Apache-2.0
// Buckets kept and taken back: the same picture from any subset, whatever happened to the file.
#include "runtime/base/temp_dir.h"
#include "tracer/checkpoint.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <map>
#include <random>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;
using trace::CheckpointFile;
using trace::CheckpointKey;
using trace::Film;
using trace::Image;

class Folder {
public:
    [[nodiscard]] std::string file(const std::string& name) const {
        return temp_.path() + "/" + name;
    }

private:
    base::TempDir temp_{"checkpoint"};
};

// A film with filters that reach into neighbours, one extra channel, and different samples
// everywhere.
class Picture {
public:
    Picture()
        : raster_(trace::make_raster(options(), diag)), sampler_({.nx = 2, .ny = 2, .jitter = 1}),
          weights_(trace::Filter("gaussian", 5, 3, diag), sampler_),
          film(Film::create(raster_, sampler_, weights_,
                            {.bucket_x = 5, .bucket_y = 7, .extra = {{}}}, diag)) {}

    // Renders what is needed, in an order of its own; returns how many buckets that were.
    std::size_t render(std::size_t limit = ~std::size_t{0}) {
        std::size_t num_rendered = 0;
        for (std::size_t b = film->num_buckets(); b-- > 0 && num_rendered < limit;) {
            if (film->needs_samples(b)) {
                render_bucket(b);
                ++num_rendered;
            }
        }
        return num_rendered;
    }

    // As the checkpoint keeps them.
    [[nodiscard]] std::vector<float> values(std::size_t bucket) const {
        const trace::PixelRange range = film->output_pixels(bucket);
        const Image& image = film->image();
        std::vector<float> out;
        for (const auto plane : image.all_planes()) {
            for (int y = range.y0; y < range.y1; ++y) {
                const auto row = plane.begin() + image.index(range.x0, y);
                out.insert(out.end(), row, row + range.width());
            }
        }
        return out;
    }

    base::Diag diag;

private:
    static rib::Options options() {
        rib::Options o;
        o.xres = 50;
        o.yres = 37;
        return o;
    }

    void render_bucket(std::size_t bucket) {
        trace::SampleBlock block;
        sampler_.fill(film->sample_pixels(bucket), block);
        trace::SampleBuffer samples = film->buffer(bucket);
        for (std::size_t i = 0; i < block.count; ++i) {
            const auto value = static_cast<float>(block.seed[i] & 1023U);
            std::ranges::fill(samples.samples[i].color, value);
            std::ranges::fill(samples.samples[i].opacity, value / 1024);
            samples.samples[i].z = value + 1;
            samples.extra[i] = value * 2;
        }
        film->submit(bucket, std::move(samples));
    }

    trace::Raster raster_;
    trace::Sampler sampler_;
    trace::FilterWeights weights_;

public:
    std::unique_ptr<Film> film;
};

bool same(const Image& a, const Image& b) {
    return a.planes == b.planes && a.extra == b.extra;
}

TEST(Film, RestoredBucketsMakeTheSamePicture) {
    Picture whole;
    EXPECT_EQ(whole.render(), whole.film->num_buckets());
    for (unsigned seed = 1; seed <= 8; ++seed) {
        Picture part;
        std::mt19937 random(seed);
        std::size_t num_restored = 0;
        for (std::size_t b = 0; b < part.film->num_buckets(); ++b) {
            if (random() % 8 < seed) { // the last seed restores all
                EXPECT_TRUE(part.film->restore(b, whole.values(b)));
                EXPECT_FALSE(part.film->restore(b, whole.values(b))) << "twice";
                ++num_restored;
            }
        }
        const std::size_t rendered = part.render();
        EXPECT_TRUE(part.film->complete());
        EXPECT_TRUE(same(part.film->image(), whole.film->image())) << "seed " << seed;
        EXPECT_EQ(rendered == 0, num_restored == part.film->num_buckets());
    }
}

TEST(Film, RestoredBucketsAreNotFilteredAgain) {
    Picture picture;
    std::vector<float> marked(picture.film->output_pixels(9).area() * picture.film->num_planes(),
                              -7.0f);
    EXPECT_FALSE(picture.film->restore(9, std::span(marked).first(marked.size() - 1)));
    EXPECT_FALSE(picture.film->restore(picture.film->num_buckets(), marked));
    ASSERT_TRUE(picture.film->restore(9, marked));
    picture.render();
    EXPECT_TRUE(picture.film->complete());
    EXPECT_EQ(picture.values(9), marked);
}

// --- the file

CheckpointKey some_key(std::uint8_t frame = 1) {
    CheckpointKey key;
    key.frame.fill(frame);
    key.num_buckets = 8;
    key.num_planes = 3;
    return key;
}

using Records = std::map<std::size_t, std::vector<float>>;

CheckpointFile::Resumed read_all(CheckpointFile& file, const std::string& path, Records& records) {
    return file.resume(path, some_key(), [&](std::size_t bucket, std::span<const float> values) {
        records[bucket].assign(values.begin(), values.end());
    });
}

Records write_some(const std::string& path) {
    Records records;
    CheckpointFile file;
    EXPECT_TRUE(file.create(path, some_key()));
    for (std::size_t b = 0; b < 5; ++b) {
        records[b] = std::vector<float>(10 + b, static_cast<float>(b) + 0.5f);
        EXPECT_TRUE(file.append(b, records[b]));
    }
    EXPECT_TRUE(file.sync());
    return records;
}

TEST(CheckpointFile, GoesOnBehindWhatIsThere) {
    const Folder folder;
    const std::string path = folder.file("c");
    Records expected = write_some(path);
    {
        CheckpointFile file;
        Records found;
        ASSERT_EQ(read_all(file, path, found), CheckpointFile::Resumed::Yes);
        EXPECT_EQ(found, expected);
        expected[7] = {1, 2, 3};
        EXPECT_TRUE(file.append(7, expected[7]));
        EXPECT_TRUE(file.flush());
    }
    CheckpointFile file;
    Records found;
    ASSERT_EQ(read_all(file, path, found), CheckpointFile::Resumed::Yes);
    EXPECT_EQ(found, expected);
    file.remove();
    EXPECT_FALSE(fs::exists(path));
}

// Cut anywhere, as by kill -9: every whole record is found, and appending goes on behind them.
TEST(CheckpointFile, TornEndIsCutOff) {
    const Folder folder;
    const std::string path = folder.file("c");
    const Records all = write_some(path);
    const std::uintmax_t size = fs::file_size(path);
    for (std::uintmax_t cut = size; cut > 0; cut -= std::min<std::uintmax_t>(cut, 13)) {
        write_some(path);
        fs::resize_file(path, cut);
        CheckpointFile file;
        Records found;
        const auto resumed = read_all(file, path, found);
        if (resumed == CheckpointFile::Resumed::Foreign) {
            EXPECT_LT(cut, 76u) << "less than a header";
            continue;
        }
        ASSERT_EQ(resumed, CheckpointFile::Resumed::Yes);
        for (const auto& [bucket, values] : found) {
            EXPECT_EQ(values, all.at(bucket));
        }
        EXPECT_EQ(found.size() == all.size(), cut == size);
    }
}

// One wrong bit anywhere never gets into a picture.
TEST(CheckpointFile, DamageIsNoticed) {
    const Folder folder;
    const std::string path = folder.file("c");
    const Records all = write_some(path);
    const std::uintmax_t size = fs::file_size(path);
    for (std::uintmax_t at = 0; at < size; at += 7) {
        write_some(path);
        std::fstream edit(path, std::ios::in | std::ios::out | std::ios::binary);
        edit.seekg(static_cast<std::streamoff>(at));
        const int byte = edit.get();
        edit.seekp(static_cast<std::streamoff>(at));
        edit.put(static_cast<char>(byte ^ 0x10));
        edit.close();
        CheckpointFile file;
        Records found;
        const auto resumed = read_all(file, path, found);
        EXPECT_EQ(resumed,
                  at < 76 ? CheckpointFile::Resumed::Foreign : CheckpointFile::Resumed::Yes);
        EXPECT_LT(found.size(), all.size());
        for (const auto& [bucket, values] : found) {
            EXPECT_EQ(values, all.at(bucket));
        }
    }
}

TEST(CheckpointFile, RefusesOthers) {
    const Folder folder;
    const std::string path = folder.file("c");
    CheckpointFile file, second;
    Records found;
    EXPECT_EQ(read_all(file, path, found), CheckpointFile::Resumed::Missing);
    EXPECT_EQ(read_all(file, folder.file(""), found), CheckpointFile::Resumed::Failed);
    std::ofstream(path) << "something else";
    EXPECT_FALSE(trace::is_checkpoint(path));
    EXPECT_EQ(read_all(file, path, found), CheckpointFile::Resumed::Foreign);
    trace::remove_stale_checkpoint(path);
    EXPECT_TRUE(fs::exists(path)) << "not ours";

    ASSERT_TRUE(file.create(path, some_key(2)));
    EXPECT_EQ(read_all(second, path, found), CheckpointFile::Resumed::Busy);
    EXPECT_FALSE(second.create(path, some_key()));
    EXPECT_EQ(second.error(), EWOULDBLOCK);
    trace::remove_stale_checkpoint(path);
    EXPECT_TRUE(fs::exists(path)) << "in use";
}

TEST(CheckpointFile, FullDiskIsAnError) {
    CheckpointFile file;
    if (fs::exists("/dev/full")) { // no regular file: refused before anything is written
        EXPECT_FALSE(file.create("/dev/full", some_key()));
        EXPECT_EQ(file.error(), EINVAL);
    }
}

// --- the watcher

trace::CheckpointSettings at_once(bool resume) {
    return {.enabled = true, .after_s = 0, .directory = "", .resume = resume};
}

trace::Checkpoint::Hash some_hash() {
    return {1, 2, 3};
}

TEST(Checkpoint, InterruptedPictureGoesOn) {
    const Folder folder;
    const std::string path = folder.file("c");
    Picture whole;
    whole.render();
    {
        Picture first;
        trace::Checkpoint checkpoint(at_once(false), path, some_hash, first.diag);
        checkpoint.start(*first.film);
        first.render(40);
        checkpoint.finish();
    }
    Picture second;
    trace::Checkpoint checkpoint(at_once(true), path, some_hash, second.diag);
    checkpoint.start(*second.film);
    // Four of six rows were rendered, three filtered: one is needed again for its samples.
    EXPECT_EQ(second.render(), second.film->num_buckets() * 4 / 6);
    checkpoint.finish();
    EXPECT_TRUE(same(second.film->image(), whole.film->image()));
    checkpoint.remove();
    EXPECT_FALSE(fs::exists(path));
    EXPECT_EQ(second.diag.count(base::Severity::Warning), 0u);
}

TEST(Checkpoint, AnotherFrameIsRefused) {
    const Folder folder;
    const std::string path = folder.file("c");
    {
        Picture first;
        trace::Checkpoint checkpoint(at_once(false), path, some_hash, first.diag);
        checkpoint.start(*first.film);
        first.render();
        checkpoint.finish();
    }
    Picture second;
    trace::Checkpoint checkpoint(
        at_once(true), path, [] { return trace::Checkpoint::Hash{9}; }, second.diag);
    checkpoint.start(*second.film);
    EXPECT_EQ(second.render(), second.film->num_buckets());
    checkpoint.finish();
    EXPECT_EQ(second.diag.count(base::Severity::Warning), 1u);
}

TEST(Checkpoint, ShortFramesLeaveNothing) {
    const Folder folder;
    const std::string path = folder.file("c");
    Picture picture;
    trace::CheckpointSettings settings = at_once(false);
    settings.after_s = 1000;
    trace::Checkpoint checkpoint(settings, path, some_hash, picture.diag);
    checkpoint.start(*picture.film);
    picture.render();
    checkpoint.finish();
    EXPECT_FALSE(fs::exists(path));
}

TEST(Checkpoint, TroubleIsOneWarning) {
    const Folder folder;
    Picture picture;
    trace::Checkpoint checkpoint(at_once(true), folder.file("no/such/place"), some_hash,
                                 picture.diag);
    checkpoint.start(*picture.film);
    picture.render();
    checkpoint.finish();
    EXPECT_TRUE(picture.film->complete());
    EXPECT_EQ(picture.diag.count(base::Severity::Warning), 1u);
    EXPECT_EQ(trace::checkpoint_path("a/b.tif", "d"), "d/a%b.tif.perigee-checkpoint");
    EXPECT_EQ(trace::checkpoint_path("", ""), "");
}

} // namespace
