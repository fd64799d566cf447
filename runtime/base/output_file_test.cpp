// SPDX-License-Identifier: Apache-2.0
// Files appear complete or not at all, whatever goes wrong in between.
#include "runtime/base/file.h"
#include "runtime/base/output_file.h"
#include "runtime/base/temp_dir.h"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace {

namespace fs = std::filesystem;
using base::OutputFile;

class OutputFileTest : public testing::Test {
protected:
    [[nodiscard]] std::string path(const std::string& name) const { return (dir_ / name).string(); }
    [[nodiscard]] std::size_t entries() const {
        return static_cast<std::size_t>(std::distance(fs::directory_iterator(dir_), {}));
    }
    const base::TempDir temp_{"perigee"};
    const fs::path dir_ = temp_.path();
};

void write_text(OutputFile& file, const std::string& text) {
    file.write(text.data(), text.size());
}

TEST_F(OutputFileTest, AppearsOnCommitOnly) {
    {
        OutputFile file(path("a"));
        write_text(file, "hello");
        EXPECT_FALSE(fs::exists(path("a")));
        EXPECT_TRUE(file.commit());
    }
    EXPECT_EQ(base::read_file(path("a")), "hello");
    EXPECT_EQ(entries(), 1U);
    {
        OutputFile file(path("a")); // the old file stays until then
        write_text(file, "lost");
    }
    EXPECT_EQ(base::read_file(path("a")), "hello");
    EXPECT_EQ(entries(), 1U);
    {
        OutputFile file(path("a"));
        write_text(file, "new");
        EXPECT_TRUE(file.commit());
    }
    EXPECT_EQ(base::read_file(path("a")), "new");
    EXPECT_EQ(entries(), 1U);
}

TEST_F(OutputFileTest, SeeksAndReadsBack) {
    OutputFile file(path("a"));
    const std::string big(1'000'000, 'x');
    write_text(file, "head");
    write_text(file, big);
    file.seek(1);
    write_text(file, "EA");
    char back[4] = {};
    file.seek(0);
    EXPECT_EQ(file.read(back, 4), 4U);
    EXPECT_EQ(std::string(back, 4), "hEAd");
    EXPECT_EQ(file.position(), 4U);
    EXPECT_EQ(file.size(), big.size() + 4);
    file.seek(file.size());
    write_text(file, "tail");
    EXPECT_TRUE(file.commit());
    EXPECT_EQ(base::read_file(path("a")), "hEAd" + big + "tail");
}

TEST_F(OutputFileTest, KeepsLinksAndPermissions) {
    { std::ofstream(path("real")) << "old"; }
    fs::create_symlink("real", path("link"));
    OutputFile file(path("link"));
    write_text(file, "new");
    EXPECT_TRUE(file.commit());
    EXPECT_TRUE(fs::is_symlink(path("link")));
    EXPECT_EQ(base::read_file(path("real")), "new");
    struct stat info {};
    ::stat(path("real").c_str(), &info);
    const mode_t mask = ::umask(0);
    ::umask(mask);
    EXPECT_EQ(info.st_mode & 0777U, 0666U & ~mask);
}

TEST_F(OutputFileTest, DevicesAreWrittenDirectly) {
    OutputFile null("/dev/null");
    write_text(null, "x");
    EXPECT_TRUE(null.commit());
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
    OutputFile full("/dev/full");
    write_text(full, "x");
    EXPECT_FALSE(full.commit());
    EXPECT_EQ(full.error(), ENOSPC);
    EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST_F(OutputFileTest, PlacesThatCannotBeWritten) {
    EXPECT_EQ(OutputFile(path("no/such/dir")).error(), ENOENT);
    EXPECT_EQ(OutputFile(dir_.string()).error(), EISDIR);
    ::mkfifo(path("pipe").c_str(), 0600);
    EXPECT_EQ(OutputFile(path("pipe")).error(), ENXIO); // nobody reads: no hanging
    if (::geteuid() != 0) {
        fs::permissions(dir_, fs::perms::owner_read | fs::perms::owner_exec);
        EXPECT_EQ(OutputFile(path("a")).error(), EACCES);
        fs::permissions(dir_, fs::perms::owner_all);
    }
    OutputFile refused(path("no/such/dir"));
    EXPECT_FALSE(refused.write("x", 1));
    EXPECT_FALSE(refused.commit());
}

TEST_F(OutputFileTest, KilledWriterLeavesNothing) {
    const pid_t child = ::fork();
    if (child == 0) {
        OutputFile file(path("a"));
        const std::string text(500'000, 'x');
        file.write(text.data(), text.size());
        ::kill(::getpid(), SIGKILL);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status));
    // Where the file system knows no unnamed files a temporary one stays behind; never one of the
    // final name.
    EXPECT_FALSE(fs::exists(path("a")));
    EXPECT_LE(entries(), 1U);
}

} // namespace
