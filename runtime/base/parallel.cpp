// SPDX-License-Identifier: Apache-2.0
#include "runtime/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>
#include <thread>

namespace base {

namespace {

// Each worker takes the next item until none is left. Taking from one counter, not splitting
// ranges, keeps the order.
void drain(std::atomic<std::size_t>& next, std::atomic<bool>& stop, std::size_t num_items, int slot,
           const std::function<bool(std::size_t, int)>& body) {
    while (!stop.load(std::memory_order_relaxed)) {
        const std::size_t item = next.fetch_add(1, std::memory_order_relaxed);
        if (item >= num_items) {
            return;
        }
        if (!body(item, slot)) {
            stop.store(true, std::memory_order_relaxed);
        }
    }
}

} // namespace

int thread_count(int num_threads) {
    const int available = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    return num_threads > 0 ? std::min(num_threads, 1024) : available;
}

void parallel_for(std::size_t num_items, int num_threads,
                  const std::function<bool(std::size_t item, int slot)>& body) {
    const auto workers = static_cast<int>(
        std::min<std::size_t>(num_items, static_cast<std::size_t>(thread_count(num_threads))));
    std::atomic<std::size_t> next{0};
    std::atomic<bool> stop{false};
    if (workers <= 1) {
        drain(next, stop, num_items, 0, body);
        return;
    }
    // The library offers no more threads than the machine has unless told; tests ask for more.
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(std::max(workers, thread_count(0))));
    tbb::task_arena arena(workers);
    arena.execute([&] {
        tbb::task_group group;
        // A worker's slot is the task's number, not the thread's: each task runs on one thread from
        // start to end.
        for (int slot = 0; slot < workers; ++slot) {
            group.run([&, slot] { drain(next, stop, num_items, slot, body); });
        }
        group.wait();
    });
}

} // namespace base
