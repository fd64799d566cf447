// SPDX-License-Identifier: Apache-2.0
// A fuzz target is one file that defines this function. With -Dfuzz=true libFuzzer calls it with
// bytes it invents (docs/robustness.md); every build replays the seeds of testsuite/fuzz/<target>
// through fuzz_replay.cpp. Whatever the bytes are, the function returns 0 in bounded time and
// memory, and aborts where a promise is broken.
#pragma once

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
