// SPDX-License-Identifier: Apache-2.0
// Ctrl-C and SIGTERM: asked for politely, so that nothing half-written stays behind. A second
// signal ends the process at once.
#pragma once

namespace trace {

// Call once, before work starts.
void catch_interrupts();
[[nodiscard]] bool is_interrupted();
// Ends the process by the signal that came, so that shells and queues see it; returns if none came.
void finish_interrupt();

} // namespace trace
