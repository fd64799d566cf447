// SPDX-License-Identifier: Apache-2.0
// Archives: what was put in comes out, damaged ones are refused, ar(1) reads ours and we its.
#include "runtime/base/ar_file.h"
#include "runtime/base/file.h"
#include "runtime/base/temp_dir.h"

#include <gtest/gtest.h>

namespace base {
namespace {

using Members = std::vector<std::pair<std::string, std::string>>;

class Archive : public ::testing::Test {
protected:
    const TempDir dir{"ar-test"};
    const std::string path = dir.path() + "/a.ar";
    const Members members = {{"short.slo", "1234567"},
                             {"a_name_longer_than_the_header.slo", std::string(1000, 'x')},
                             {"fifteen_signs__", "even"},
                             {"empty", ""},
                             {"another_long_name_with_bytes.slo", std::string("\0\n`\n/", 5)}};
    std::string why;

    std::unique_ptr<ArFile> open(const std::string& bytes) {
        EXPECT_EQ(write_file_atomically(path, bytes), "");
        return ArFile::open(path, why);
    }
};

TEST_F(Archive, GivesBackWhatWasPutIn) {
    const auto file = open(ar_bytes(members));
    ASSERT_TRUE(file) << why;
    EXPECT_EQ(file->names().size(), members.size());
    for (const auto& [name, content] : members) {
        EXPECT_TRUE(file->contains(name)) << name;
        EXPECT_EQ(file->read(name), content) << name;
    }
    EXPECT_FALSE(file->contains("absent"));
    EXPECT_EQ(file->read("absent"), std::nullopt);
    EXPECT_EQ(ar_bytes(members), ar_bytes(members));
    const auto empty = open(ar_bytes({}));
    ASSERT_TRUE(empty);
    EXPECT_TRUE(empty->names().empty());
}

TEST_F(Archive, DamageIsNeverRead) {
    const std::string good = ar_bytes(members);
    EXPECT_EQ(open(""), nullptr);
    EXPECT_EQ(open("no archive at all"), nullptr);
    EXPECT_EQ(ArFile::open(dir.path(), why), nullptr);
    EXPECT_EQ(ArFile::open(path + "-absent", why), nullptr);
    for (std::size_t n = 0; n < good.size(); ++n) { // every truncation
        if (const auto file = open(good.substr(0, n))) {
            for (const std::string& name : file->names()) {
                EXPECT_TRUE(file->read(name)) << n;
            }
        }
    }
    for (std::size_t at = 8; at < good.size(); at += 3) { // any byte: refused or still in bounds
        std::string damaged = good;
        damaged[at] = static_cast<char>(damaged[at] ^ 0x15);
        if (const auto file = open(damaged)) {
            for (const std::string& name : file->names()) {
                (void)file->read(name);
            }
        }
    }
}

TEST_F(Archive, TheSystemsToolAgrees) {
    if (std::system("ar --version >/dev/null 2>&1") != 0) {
        GTEST_SKIP() << "no ar";
    }
    ASSERT_TRUE(open(ar_bytes(members)));
    const std::string d = dir.path();
    const std::string list = "cd " + d +
                             " && mkdir x && cd x && ar x ../a.ar && ar t ../a.ar | sort "
                             "> ../list && ar rcS ../b.ar *";
    ASSERT_EQ(std::system(list.c_str()), 0);
    const auto theirs = ArFile::open(d + "/b.ar", why);
    ASSERT_TRUE(theirs) << why;
    std::string names;
    for (const std::string& name : theirs->names()) {
        names += name + "\n";
        const auto ours = ArFile::open(path, why);
        EXPECT_EQ(theirs->read(name), ours->read(name)) << name;
    }
    EXPECT_EQ(theirs->names().size(), members.size());
}

} // namespace
} // namespace base
