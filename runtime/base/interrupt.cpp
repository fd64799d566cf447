// SPDX-License-Identifier: Apache-2.0
#include "runtime/base/interrupt.h"

#include <csignal>
#include <fcntl.h>
#include <initializer_list>
#include <unistd.h>

namespace base {

namespace {

// The one variable of static storage that changes: a signal handler can reach nothing else.
volatile std::sig_atomic_t caught_signal = 0;

void remember(int signal) {
    if (caught_signal != 0) { // the second one
        std::signal(signal, SIG_DFL);
        std::raise(signal);
    }
    caught_signal = signal;
}

// nohup and shells without job control ignore signals for us: that stays so.
void catch_unless_ignored(int signal) {
    struct sigaction action = {};
    if (sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN) {
        return;
    }
    action = {};
    action.sa_handler = remember;
    sigemptyset(&action.sa_mask);
    sigaction(signal, &action, nullptr); // no SA_RESTART: a read that waits must notice
}

} // namespace

void catch_interrupts() {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        catch_unless_ignored(signal);
    }
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
}

void open_standard_streams() {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        if (::fcntl(stream, F_GETFD) < 0) {
            // The lowest free number is this one.
            static_cast<void>(::open("/dev/null", stream == STDIN_FILENO ? O_RDONLY : O_WRONLY));
        }
    }
}

bool is_interrupted() {
    return caught_signal != 0;
}

void finish_interrupt() {
    if (caught_signal != 0) {
        std::signal(caught_signal, SIG_DFL);
        std::raise(caught_signal);
    }
}

} // namespace base
