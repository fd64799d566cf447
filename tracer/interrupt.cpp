// SPDX-License-Identifier: Apache-2.0
#include "tracer/interrupt.h"

#include <csignal>

namespace trace {

namespace {

// The one variable of static storage that changes: a signal handler can reach nothing else.
volatile std::sig_atomic_t caught_signal = 0;

void remember(int signal) {
    caught_signal = signal;
}

} // namespace

void catch_interrupts() {
    struct sigaction action = {};
    action.sa_handler = remember;
    sigemptyset(&action.sa_mask);
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
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

} // namespace trace
