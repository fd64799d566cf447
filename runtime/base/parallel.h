// SPDX-License-Identifier: Apache-2.0
// Work spread over threads; the only place that knows the task library.
// In: a number of independent items and a body. The body gets the item and the *slot* of the thread
// that runs it (0 .. num_slots-1): per-thread scratch is an array indexed by slot. Items start in
// increasing order, so that neighbours share caches and progress is even. Whatever needs an order
// (sums, messages) is merged by item, never by slot or time, so results do not depend on the number
// of threads.
#pragma once

#include <cstddef>
#include <functional>

namespace base {

// Threads that a request for `num_threads` gets; 0 asks for all the machine has.
[[nodiscard]] int thread_count(int num_threads);

// Calls body(item, slot) for every item in 0 .. num_items-1. Returning false stops: no new item
// starts. One thread (or one item) runs here without starting the task library. Bodies must not
// throw.
void parallel_for(std::size_t num_items, int num_threads,
                  const std::function<bool(std::size_t item, int slot)>& body);

} // namespace base
