// SPDX-License-Identifier: Apache-2.0
#include "runtime/base/work_queue.h"

namespace base {

void WorkQueue::stop() {
    {
        const std::lock_guard lock(mutex_);
        ending_ = true;
        tasks_.clear();
    }
    changed_.notify_all();
    threads_.clear(); // joins
}

void WorkQueue::add(std::function<void()> task) {
    const std::lock_guard lock(mutex_);
    if (ending_) {
        return;
    }
    tasks_.push_back(std::move(task));
    if (tasks_.size() > num_idle_ && threads_.size() < max_threads_) {
        threads_.emplace_back([this] { work(); });
    }
    changed_.notify_one();
}

void WorkQueue::work() {
    std::unique_lock lock(mutex_);
    while (true) {
        ++num_idle_;
        changed_.wait(lock, [this] { return ending_ || !tasks_.empty(); });
        --num_idle_;
        if (ending_) {
            return;
        }
        const std::function<void()> task = std::move(tasks_.front());
        tasks_.pop_front();
        lock.unlock();
        task();
        lock.lock();
    }
}

} // namespace base
