// SPDX-License-Identifier: Apache-2.0
#include "runtime/base/file.h"
#include "runtime/base/seal.h"
#include "runtime/base/sha256.h"

#include <filesystem>
#include <gtest/gtest.h>

namespace base {
namespace {

// FIPS 180-4 examples.
TEST(Sha256, KnownDigests) {
    EXPECT_EQ(sha256_hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    EXPECT_EQ(sha256_hex("abc"),
              "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(sha256_hex("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
              "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    EXPECT_EQ(sha256_hex(std::string(1'000'000, 'a')),
              "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, PiecesEqualTheWhole) {
    const std::string text(1000, 'x');
    for (const std::size_t piece : {1U, 63U, 64U, 65U, 999U}) {
        Sha256 hash;
        for (std::size_t at = 0; at < text.size(); at += piece) {
            hash.add(std::string_view(text).substr(at, piece));
        }
        EXPECT_EQ(hash.hex(), sha256_hex(text)) << piece;
    }
}

TEST(Seal, TellsWhatIsWrong) {
    const std::string mine(64, 'a');
    const std::string other(64, 'b');
    const std::string good = "content" + seal("content", mine);
    EXPECT_EQ(check_seal(good, mine), SealState::Good);
    EXPECT_EQ(check_seal(good, other), SealState::OtherFingerprint);
    std::string damaged = good;
    damaged[2] ^= 1;
    EXPECT_EQ(check_seal(damaged, mine), SealState::Damaged);
    for (std::size_t n = 0; n < good.size(); ++n) {
        EXPECT_NE(check_seal(good.substr(0, n), mine), SealState::Good) << n;
    }
}

TEST(File, WritesAtomicallyAndReadsBack) {
    const auto dir = std::filesystem::temp_directory_path() /
                     ("perigee-file-test-" + std::to_string(::getpid()));
    std::filesystem::create_directories(dir);
    const std::string path = (dir / "x").string();
    EXPECT_EQ(write_file_atomically(path, "one"), "");
    EXPECT_EQ(write_file_atomically(path, "two"), "");
    EXPECT_EQ(read_file(path), "two");
    EXPECT_EQ(read_file(path, 2), std::nullopt);
    EXPECT_EQ(read_file(dir.string()), std::nullopt);
    EXPECT_NE(write_file_atomically((dir / "none" / "x").string(), "y"), "");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(dir), {}), 1)
        << "no temporary is left";
    std::filesystem::remove_all(dir);
}

} // namespace
} // namespace base
