// SPDX-License-Identifier: Apache-2.0
// The cache as a directory: what is kept, what goes first, what killed processes leave, where
// nothing can be written.
#include "runtime/base/file.h"
#include "runtime/base/sha256.h"
#include "runtime/base/temp_dir.h"
#include "runtime/shader_cache.h"

#include <chrono>
#include <filesystem>
#include <gtest/gtest.h>

namespace rt {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

std::string key(int i) {
    return base::sha256_hex(std::to_string(i));
}

class Cache : public ::testing::Test {
protected:
    const base::TempDir dir{"cache-test"};

    static void age(const std::string& path, std::chrono::hours by) {
        fs::last_write_time(path, fs::file_time_type::clock::now() - by);
    }
    [[nodiscard]] std::uint64_t bytes_kept() const {
        std::uint64_t total = 0;
        for (const auto& entry : fs::recursive_directory_iterator(dir.path())) {
            total += entry.is_regular_file() ? entry.file_size() : 0;
        }
        return total;
    }
};

TEST_F(Cache, SizesAreRead) {
    EXPECT_EQ(parse_cache_size("0"), 0U);
    EXPECT_EQ(parse_cache_size("1000"), 1000U);
    EXPECT_EQ(parse_cache_size("200M"), 200U << 20);
    EXPECT_EQ(parse_cache_size("3k"), 3U << 10);
    EXPECT_EQ(parse_cache_size("2G"), std::uint64_t{2} << 30);
    for (const char* wrong : {"", "M", "1.5G", "12X", "-1", "1GB", "99999999999999T"}) {
        EXPECT_EQ(parse_cache_size(wrong), std::nullopt) << wrong;
    }
}

TEST_F(Cache, LeastRecentlyUsedGoFirst) {
    ShaderCache cache(dir.path(), 100'000);
    for (int i = 0; i < 9; ++i) {
        EXPECT_EQ(cache.store(key(i), std::string(10'000, 'x')), "");
        age(cache.object_path(key(i)), std::chrono::hours(100 - i));
    }
    ShaderCache::mark_used(cache.object_path(key(0))); // the oldest, but in use
    EXPECT_EQ(cache.store(key(9), std::string(10'000, 'x')), "");
    EXPECT_EQ(cache.store(key(10), std::string(10'000, 'x')), "");
    cache.trim();
    EXPECT_LE(bytes_kept(), 100'000U);
    EXPECT_TRUE(fs::exists(cache.object_path(key(0))));
    EXPECT_FALSE(fs::exists(cache.object_path(key(1))));
    EXPECT_TRUE(fs::exists(cache.object_path(key(8))));
    EXPECT_TRUE(fs::exists(cache.object_path(key(10))));
}

TEST_F(Cache, RoomIsMadeAtTheEndOfARun) {
    {
        ShaderCache cache(dir.path(), 50'000);
        for (int i = 0; i < 20; ++i) {
            EXPECT_EQ(cache.store(key(i), std::string(5'000, 'x')), "");
        }
    }
    EXPECT_LE(bytes_kept(), 50'000U);
    EXPECT_GE(bytes_kept(), 40'000U);
}

TEST_F(Cache, LeftoversOfTheKilledGo) {
    ShaderCache cache(dir.path(), 1'000'000);
    EXPECT_EQ(cache.store(key(1), "object"), "");
    const std::string stem = cache.object_path(key(1));
    for (const char* name : {".1-1.tmp", ".2-2.tmp", ".lock"}) {
        EXPECT_EQ(base::write_file_atomically(stem + name, "x"), "");
    }
    age(stem + ".1-1.tmp", 2h);
    age(stem + ".lock", 2h);
    cache.trim();
    EXPECT_TRUE(fs::exists(stem));
    EXPECT_FALSE(fs::exists(stem + ".1-1.tmp"));
    EXPECT_FALSE(fs::exists(stem + ".lock"));
    EXPECT_TRUE(fs::exists(stem + ".2-2.tmp")) << "somebody may be writing it";
}

TEST_F(Cache, NowhereToWrite) {
    EXPECT_EQ(base::write_file_atomically(dir.path() + "/file", "x"), "");
    ShaderCache cache(dir.path() + "/file/below", 1'000'000);
    EXPECT_NE(cache.store(key(1), "object"), "");
    EXPECT_FALSE(cache.lock(key(1), {}).is_held());
    cache.trim();
    EXPECT_FALSE(ShaderCache(dir.path(), 0).is_on());
    EXPECT_FALSE(ShaderCache("", 1).is_on());
}

} // namespace
} // namespace rt
