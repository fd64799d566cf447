// SPDX-License-Identifier: Apache-2.0
// posix_spawn with both output streams on pipes that are drained together, so that neither can
// block the program.
#include "slc/process.h"

#include "runtime/base/descriptor.h"
#include "runtime/base/file.h"

#include <array>
#include <cerrno>
#include <csignal>
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

using base::Descriptor;

struct Pipe {
    Descriptor read, write;
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

// Input as an anonymous file: unlike a pipe it needs no writer that keeps pace.
bool open_input(Descriptor& fd, std::string_view input) {
    fd.reset(memfd_create("input", MFD_CLOEXEC));
    return fd.get() >= 0 && base::write_all(fd.get(), input) && lseek(fd.get(), 0, SEEK_SET) == 0;
}

// The environment of the program: ours, but in English and with its own place for temporary files.
class Environment {
public:
    explicit Environment(const std::string& temp_dir) : temp_("TMPDIR=" + temp_dir) {
        for (char** e = environ; *e != nullptr; ++e) {
            const std::string_view entry = *e;
            if (!entry.starts_with("LC_") && !entry.starts_with("LANG") &&
                (temp_dir.empty() || !entry.starts_with("TMPDIR="))) {
                entries_.push_back(*e);
            }
        }
        entries_.push_back(locale_.data());
        if (!temp_dir.empty()) {
            entries_.push_back(temp_.data());
        }
        entries_.push_back(nullptr);
    }
    Environment(const Environment&) = delete;
    Environment& operator=(const Environment&) = delete;
    [[nodiscard]] char** entries() { return entries_.data(); }

private:
    std::string locale_ = "LC_ALL=C", temp_;
    std::vector<char*> entries_;
};

void limit(pid_t child, const ProcessSettings& settings) {
    const rlimit cpu{settings.cpu_seconds, settings.cpu_seconds};
    const rlimit memory{settings.memory_bytes, settings.memory_bytes};
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

void collect(Descriptor& out, Descriptor& err, ProcessResult& result,
             const ProcessSettings& settings) {
    const int patience_ms = settings.cancelled ? 30 : -1;
    std::array<pollfd, 2> fds{{{out.get(), POLLIN, 0}, {err.get(), POLLIN, 0}}};
    std::array<std::string*, 2> into{&result.out, &result.err};
    while ((fds[0].fd >= 0 || fds[1].fd >= 0) && !result.cut_off) {
        const int num_ready = poll(fds.data(), fds.size(), patience_ms);
        if (num_ready < 0 && errno != EINTR) {
            return;
        }
        if (settings.cancelled && settings.cancelled()) {
            result.cancelled = true;
            return;
        }
        if (num_ready <= 0) {
            continue;
        }
        for (std::size_t i = 0; i < fds.size(); ++i) {
            if (fds[i].fd >= 0 && fds[i].revents != 0 &&
                !drain(fds[i].fd, *into[i], settings.output_bytes, result.cut_off)) {
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
                          const ProcessSettings& settings) {
    ProcessResult result;
    Descriptor in;
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
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF);
    posix_spawnattr_setpgroup(&attributes, 0);
    sigset_t ignored_here; // what base/interrupt.h ignores for this process only
    sigemptyset(&ignored_here);
    sigaddset(&ignored_here, SIGPIPE);
    sigaddset(&ignored_here, SIGXFSZ);
    posix_spawnattr_setsigdefault(&attributes, &ignored_here);
    Environment environment(settings.temp_dir);
    pid_t child = 0;
    const int status =
        posix_spawnp(&child, args[0], &actions, &attributes, args.data(), environment.entries());
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    if (status != 0) {
        return result;
    }
    result.started = true;
    limit(child, settings);
    out.write.reset();
    err.write.reset();
    collect(out.read, err.read, result, settings);
    if (result.cut_off || result.cancelled) {
        kill(-child, SIGKILL); // the whole group: a compiler is several processes
    }
    result.exit_code = wait_for(child);
    return result;
}

} // namespace slc
