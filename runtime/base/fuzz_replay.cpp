// SPDX-License-Identifier: Apache-2.0
// Runs a fuzz target over every file of a folder, without a fuzzer: seeds and mended faults as a
// test.
#include "runtime/base/fuzz.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

int main(int argc, char** argv) {
    int num_files = 0;
    for (int i = 1; i < argc; ++i) {
        for (const auto& entry : std::filesystem::directory_iterator(argv[i])) {
            std::ifstream file(entry.path(), std::ios::binary);
            const std::string bytes{std::istreambuf_iterator<char>(file), {}};
            std::printf("%s\n", entry.path().c_str()); // the last line names what crashed
            std::fflush(stdout);
            (void)LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()),
                                         bytes.size());
            ++num_files;
        }
    }
    std::printf("%d inputs\n", num_files);
    return num_files > 0 ? 0 : 1;
}
