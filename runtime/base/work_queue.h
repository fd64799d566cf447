// SPDX-License-Identifier: Apache-2.0
// Tasks done in the background, in the order they came, by a bounded number of threads. For work
// that mostly waits (compilers, files), beside base/parallel.h, whose threads compute. Threads
// start when there is something to do.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace base {

class WorkQueue {
public:
    explicit WorkQueue(int num_threads) : max_threads_(static_cast<std::size_t>(num_threads)) {}
    ~WorkQueue() { stop(); }
    WorkQueue(const WorkQueue&) = delete;
    WorkQueue& operator=(const WorkQueue&) = delete;

    // Safe from any thread. Tasks must not throw, and must not wait for tasks added after them.
    void add(std::function<void()> task);
    // Drops tasks that have not begun and waits for the others; later ones are never done.
    void stop();

private:
    void work();

    std::size_t max_threads_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::function<void()>> tasks_;
    std::size_t num_idle_ = 0;
    bool ending_ = false;
    std::vector<std::jthread> threads_;
};

} // namespace base
