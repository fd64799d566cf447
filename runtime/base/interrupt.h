// SPDX-License-Identifier: Apache-2.0
// Signals. Ctrl-C, SIGTERM and a closed terminal ask politely: nothing half-written stays behind,
// and what is finished is kept. A second one ends the process at once. Readers that went away and
// files that grow too large are errors of the write, not deadly signals.
#pragma once

namespace base {

// Call once, before work starts.
void catch_interrupts();
// Streams 0 to 2 that the caller closed lead nowhere from now on; a picture must not get their
// numbers and the messages with it. Call before any file is opened.
void open_standard_streams();
[[nodiscard]] bool is_interrupted();
// Ends the process by the signal that came, so that shells and queues see it; returns if none came.
void finish_interrupt();

} // namespace base
