// SPDX-License-Identifier: Apache-2.0
// Compressed streams: whole, in members, cut, damaged, growing without end; as files and archives.
#include "ribtools/rib_gzip.h"
#include "ribtools/test_util.h"
#include "runtime/base/temp_dir.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <random>

namespace {

namespace fs = std::filesystem;

std::string compressed(const std::string& text) {
    std::string out;
    const auto sink = rib::gzip_sink(rib::memory_sink(out));
    EXPECT_TRUE(sink->write(text) && sink->finish());
    return out;
}

struct Inflated {
    std::string text, error;
    bool damaged = false;
};

Inflated inflated(const std::string& bytes, std::size_t step = 1000) {
    const auto source =
        rib::open_gzip(rib::open_memory(std::make_shared<const std::string>(bytes)));
    Inflated result;
    std::string block(step, '\0');
    while (const std::size_t n = source->read(block.data(), block.size())) {
        result.text.append(block, 0, n);
    }
    result.error = source->error();
    result.damaged = source->is_damaged();
    return result;
}

std::string sample() {
    std::string text;
    std::mt19937 random(1);
    while (text.size() < 300'000) {
        text += "Translate " + std::to_string(random()) + " 0 0\n";
    }
    return text;
}

TEST(Gzip, RoundTrip) {
    const std::string text = sample();
    for (const std::size_t step : {1u, 7u, 1000u, 1000'000u}) {
        const Inflated r = inflated(compressed(text), step);
        EXPECT_EQ(r.text, text);
        EXPECT_EQ(r.error, "");
    }
    EXPECT_EQ(inflated(compressed("")).text, "");
}

TEST(Gzip, PlainStreamsPass) {
    for (const std::string text : {"", "W", "\x1f", "\x1fx", "WorldBegin"}) {
        EXPECT_EQ(inflated(text).text, text);
        EXPECT_EQ(inflated(text).error, "");
    }
}

TEST(Gzip, SeveralMembersAndPadding) {
    const Inflated r = inflated(compressed("one ") + compressed("") + compressed("two"));
    EXPECT_EQ(r.text, "one two");
    EXPECT_EQ(r.error, "");
    EXPECT_EQ(inflated(compressed("one") + std::string(1000, '\0')).error, "");
    EXPECT_NE(inflated(compressed("one") + "two").error, "");
}

TEST(Gzip, DamageIsOneErrorAfterWhatIsWhole) {
    const std::string text = sample(), whole = compressed(text);
    for (std::size_t n = 2; n < whole.size(); n += 1 + whole.size() / 50) {
        const Inflated r = inflated(whole.substr(0, n));
        EXPECT_TRUE(r.damaged);
        EXPECT_EQ(r.error, "the compressed data ends in the middle");
        EXPECT_TRUE(text.starts_with(r.text));
    }
    std::string bad = whole;
    bad[bad.size() / 2] ^= 0x55;
    EXPECT_TRUE(inflated(bad).damaged);
    bad = whole;
    bad[bad.size() - 6] ^= 1; // the check sum
    EXPECT_TRUE(inflated(bad).damaged);
}

// A gigabyte of blanks in a megabyte.
TEST(Gzip, BombsAreRefused) {
    const std::string block(1 << 24, ' ');
    std::string bomb;
    for (int i = 0; i < 70; ++i) {
        static const std::string member = compressed(block);
        bomb += member;
    }
    const auto source = rib::open_gzip(rib::open_memory(std::make_shared<const std::string>(bomb)));
    std::vector<char> buffer(1 << 20);
    std::uint64_t total = 0;
    while (const std::size_t n = source->read(buffer.data(), buffer.size())) {
        total += n;
    }
    EXPECT_LT(total, (std::uint64_t{1} << 30) + buffer.size());
    EXPECT_TRUE(source->is_damaged());
}

class GzipFiles : public testing::Test {
protected:
    std::string put(const std::string& name, const std::string& bytes) {
        std::ofstream(dir_ / name, std::ios::binary) << bytes;
        return (dir_ / name).string();
    }

    rib::ReadStatus read(const std::string& path) {
        std::FILE* null = std::fopen("/dev/null", "w");
        rib::ReadStatus status{};
        {
            base::Diag diag(null);
            rib::Reader reader(backend, diag, {});
            status = reader.read_file(path);
            messages = diag.messages();
        }
        std::fclose(null);
        return status;
    }

    const base::TempDir temp_{"perigee"};
    const fs::path dir_ = temp_.path();
    rib_test::Collector backend;
    std::vector<std::string> messages;
};

TEST_F(GzipFiles, FilesAndTheirArchives) {
    put("ball.rib", compressed("Sphere 1 -1 1 360"));
    const std::string top =
        put("top.rib.gz", compressed("WorldBegin ReadArchive \"ball.rib\" WorldEnd"));
    EXPECT_EQ(read(top), rib::ReadStatus::Ok);
    EXPECT_EQ(messages.size(), 0u);
    ASSERT_EQ(backend.scenes.size(), 1u);
    EXPECT_EQ(backend.scenes[0]->primitives.size(), 1u);
}

TEST_F(GzipFiles, ACutFileIsOneErrorOfTheInput) {
    std::string text = "WorldBegin AttributeBegin IfBegin \"1\"\n";
    for (int i = 0; i < 10'000; ++i) {
        text += "Sphere " + std::to_string(i) + ".5 -1 1 360\n";
    }
    const std::string whole = compressed(text + "IfEnd AttributeEnd WorldEnd");
    for (const std::size_t n : {whole.size() / 3, whole.size() / 2, whole.size() - 3}) {
        EXPECT_EQ(read(put("cut.rib", whole.substr(0, n))), rib::ReadStatus::Ok);
        ASSERT_EQ(messages.size(), 1u) << messages[0] << "\n" << messages[1];
        EXPECT_NE(messages[0].find("error: the compressed data ends in the middle"),
                  std::string::npos)
            << messages[0];
        EXPECT_EQ(messages[0].rfind((dir_ / "cut.rib:").string(), 0), 0u);
    }
}

} // namespace
