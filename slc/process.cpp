// SPDX-License-Identifier: Apache-2.0
// posix_spawn with both output streams on pipes that are drained together, so that neither can
// block the program.
#include "slc/process.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ; // NOLINT: POSIX name

namespace slc {

namespace {

// A file descriptor that is closed at the end of its scope.
class Fd {
public:
    Fd() = default;
    explicit Fd(int fd) : fd_(fd) {}
    Fd(const Fd&) = delete;
    Fd& operator=(const Fd&) = delete;
    ~Fd() { reset(); }
    void reset(int fd = -1) {
        if (fd_ >= 0) {
            close(fd_);
        }
        fd_ = fd;
    }
    [[nodiscard]] int get() const { return fd_; }

private:
    int fd_ = -1;
};

struct Pipe {
    Fd read, write;
    bool open() {
        int ends[2];
        if (pipe2(ends, O_CLOEXEC) != 0) {
            return false;
        }
        read.reset(ends[0]);
        write.reset(ends[1]);
        return true;
    }
};

bool write_all(int fd, std::string_view text) {
    while (!text.empty()) {
        const ssize_t n = write(fd, text.data(), text.size());
        if (n < 0 && errno == EINTR) {
            continue;
        }
        if (n <= 0) {
            return false;
        }
        text.remove_prefix(static_cast<std::size_t>(n));
    }
    return true;
}

// Input as an anonymous file: unlike a pipe it needs no writer that keeps pace.
bool open_input(Fd& fd, std::string_view input) {
    fd.reset(memfd_create("input", MFD_CLOEXEC));
    return fd.get() >= 0 && write_all(fd.get(), input) && lseek(fd.get(), 0, SEEK_SET) == 0;
}

std::vector<char*> english_environment() {
    std::vector<char*> env;
    for (char** e = environ; *e != nullptr; ++e) {
        if (std::strncmp(*e, "LC_", 3) != 0 && std::strncmp(*e, "LANG", 4) != 0) {
            env.push_back(*e);
        }
    }
    static char locale[] = "LC_ALL=C";
    env.push_back(locale);
    env.push_back(nullptr);
    return env;
}

void limit(pid_t child, const ProcessLimits& limits) {
    const rlimit cpu{limits.cpu_seconds, limits.cpu_seconds};
    const rlimit memory{limits.memory_bytes, limits.memory_bytes};
    prlimit(child, RLIMIT_CPU, &cpu, nullptr);
    prlimit(child, RLIMIT_AS, &memory, nullptr);
}

// Reads one ready stream; false at its end.
bool drain(int fd, std::string& into, std::size_t limit_bytes, bool& cut_off) {
    std::array<char, 65536> block;
    const ssize_t n = read(fd, block.data(), block.size());
    if (n < 0) {
        return errno == EINTR || errno == EAGAIN;
    }
    if (into.size() + static_cast<std::size_t>(n) > limit_bytes) {
        cut_off = true;
        return false;
    }
    into.append(block.data(), static_cast<std::size_t>(n));
    return n > 0;
}

void collect(Fd& out, Fd& err, ProcessResult& result, const ProcessLimits& limits) {
    std::array<pollfd, 2> fds{{{out.get(), POLLIN, 0}, {err.get(), POLLIN, 0}}};
    std::array<std::string*, 2> into{&result.out, &result.err};
    while ((fds[0].fd >= 0 || fds[1].fd >= 0) && !result.cut_off) {
        if (poll(fds.data(), fds.size(), -1) < 0 && errno != EINTR) {
            return;
        }
        for (std::size_t i = 0; i < fds.size(); ++i) {
            if (fds[i].fd >= 0 && fds[i].revents != 0 &&
                !drain(fds[i].fd, *into[i], limits.output_bytes, result.cut_off)) {
                fds[i].fd = -1;
            }
        }
    }
}

int wait_for(pid_t child) {
    int status = 0;
    while (waitpid(child, &status, 0) < 0) {
        if (errno != EINTR) {
            return -1;
        }
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

} // namespace

ProcessResult run_process(const std::vector<std::string>& argv, std::string_view input,
                          const ProcessLimits& limits) {
    ProcessResult result;
    Fd in;
    Pipe out, err;
    if (argv.empty() || !open_input(in, input) || !out.open() || !err.open()) {
        return result;
    }
    std::vector<char*> args;
    for (const std::string& a : argv) {
        args.push_back(const_cast<char*>(a.c_str())); // posix_spawn does not write to them
    }
    args.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, in.get(), 0);
    posix_spawn_file_actions_adddup2(&actions, out.write.get(), 1);
    posix_spawn_file_actions_adddup2(&actions, err.write.get(), 2);
    std::vector<char*> env = english_environment();
    pid_t child = 0;
    const int status = posix_spawnp(&child, args[0], &actions, nullptr, args.data(), env.data());
    posix_spawn_file_actions_destroy(&actions);
    if (status != 0) {
        return result;
    }
    result.started = true;
    limit(child, limits);
    out.write.reset();
    err.write.reset();
    collect(out.read, err.read, result, limits);
    if (result.cut_off) {
        kill(child, SIGKILL);
    }
    result.exit_code = wait_for(child);
    return result;
}

} // namespace slc
