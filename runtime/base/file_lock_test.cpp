// SPDX-License-Identifier: Apache-2.0
// Locks between threads and processes, what a killed process leaves; tasks in the background; kept
// messages.
#include "runtime/base/diag.h"
#include "runtime/base/file_lock.h"
#include "runtime/base/temp_dir.h"
#include "runtime/base/work_queue.h"

#include <atomic>
#include <csignal>
#include <filesystem>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace base {
namespace {

const auto never = [] { return false; };
const auto at_once = [] { return true; };

TEST(FileLock, OneHolderAtATime) {
    const TempDir dir("lock-test");
    const std::string path = dir.path() + "/lock";
    std::atomic<int> inside{0}, most{0}, turns{0};
    {
        std::vector<std::jthread> threads;
        for (int t = 0; t < 4; ++t) {
            threads.emplace_back([&] {
                for (int i = 0; i < 25; ++i) {
                    const FileLock lock(path, never);
                    EXPECT_TRUE(lock.is_held());
                    most = std::max(most.load(), ++inside);
                    ++turns;
                    --inside;
                }
            });
        }
    }
    EXPECT_EQ(most, 1);
    EXPECT_EQ(turns, 100);
    EXPECT_FALSE(std::filesystem::exists(path)) << "nothing stays behind";
}

TEST(FileLock, GivesUpAndDoesWithout) {
    const TempDir dir("lock-test");
    const FileLock first(dir.path() + "/lock", never);
    const FileLock second(dir.path() + "/lock", at_once);
    EXPECT_FALSE(second.is_held());
    const FileLock nowhere(dir.path() + "/no/such/folder", never);
    EXPECT_FALSE(nowhere.is_held());
}

TEST(FileLock, AKilledHolderLeavesNoLock) {
    const TempDir dir("lock-test");
    const std::string path = dir.path() + "/lock";
    int ready[2];
    ASSERT_EQ(::pipe(ready), 0);
    const pid_t child = ::fork();
    if (child == 0) {
        const FileLock lock(path, never);
        (void)!::write(ready[1], "x", 1);
        ::pause();
        ::_exit(0);
    }
    char byte = 0;
    ASSERT_EQ(::read(ready[0], &byte, 1), 1);
    EXPECT_FALSE(FileLock(path, at_once).is_held());
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    EXPECT_TRUE(std::filesystem::exists(path));
    EXPECT_TRUE(FileLock(path, at_once).is_held());
    EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(WorkQueue, RunsAllWithinItsBound) {
    std::atomic<int> inside{0}, most{0}, done{0};
    std::mutex mutex;
    std::condition_variable changed;
    WorkQueue queue(3);
    for (int i = 0; i < 40; ++i) {
        queue.add([&] {
            most = std::max(most.load(), ++inside);
            std::this_thread::yield();
            --inside;
            const std::lock_guard lock(mutex);
            ++done;
            changed.notify_all();
        });
    }
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return done == 40; });
    EXPECT_LE(most, 3);
}

TEST(WorkQueue, EndsWithoutWhatHasNotBegun) {
    std::atomic<bool> go_on{false};
    std::atomic<int> ran{0};
    std::jthread releaser;
    {
        WorkQueue queue(1);
        queue.add([&] {
            ++ran;
            go_on.wait(false);
        });
        while (ran == 0) {
            std::this_thread::yield();
        }
        for (int i = 0; i < 10; ++i) {
            queue.add([&] { ++ran; });
        }
        releaser = std::jthread([&] {
            go_on = true;
            go_on.notify_all();
        });
    } // waits for the first; those that had not begun by then are dropped
    EXPECT_GE(ran, 1);
    EXPECT_LE(ran, 11);
}

TEST(Diag, KeptMessagesAreSaidLater) {
    std::FILE* out = std::tmpfile();
    Diag main(out);
    Diag early(Diag::Deferred::Yes);
    (void)main.file_id("a.rib");
    const SourcePos pos{main.file_id("b.rib"), 3, 7};
    early.report(Severity::Error, Code::NoShader, early.place_from(main, pos), "broken");
    early.report(Severity::Warning, Code::None, {early.file_id("c.sl"), 1, 2}, "odd");
    early.report_once("key", Severity::Info, Code::None, {}, "once");
    EXPECT_TRUE(early.had_errors());
    EXPECT_FALSE(main.had_errors());
    main.report_once("key", Severity::Info, Code::None, {}, "said before");
    early.deliver(main);
    early.deliver(main); // nothing is left
    const std::vector<std::string> expected = {
        "perigee: info: said before", "b.rib:3:7: error: broken", "c.sl:1:2: warning: odd"};
    EXPECT_EQ(main.messages(), expected);
    EXPECT_EQ(main.count(Severity::Error), 1U);
    EXPECT_EQ(main.last_code(), Code::NoShader);
    std::fclose(out);
}

} // namespace
} // namespace base
