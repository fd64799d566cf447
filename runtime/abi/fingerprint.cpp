// SPDX-License-Identifier: Apache-2.0
// Build-time program: hashes the files it is given and prints a header that defines NAME as the
// hash. The compiler and the loader include the same header, so objects made for other tables are
// refused and nobody has to remember a version number.
#include "runtime/base/file.h"
#include "runtime/base/sha256.h"

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

int main(int argc, char** argv) {
    if (argc < 4) {
        std::fprintf(stderr, "usage: fingerprint NAME output.h file...\n");
        return 2;
    }
    base::Sha256 hash;
    for (int i = 3; i < argc; ++i) {
        const auto text = base::read_file(argv[i]);
        if (!text) {
            std::fprintf(stderr, "fingerprint: cannot read %s\n", argv[i]);
            return 3;
        }
        hash.add_field(*text);
    }
    const std::string header = "/* made by runtime/abi/fingerprint.cpp */\n#define " +
                               std::string(argv[1]) + " \"" + hash.hex() + "\"\n";
    const std::string error = base::write_file_atomically(argv[2], header);
    if (!error.empty()) {
        std::fprintf(stderr, "fingerprint: %s\n", error.c_str());
        return 3;
    }
    return 0;
}
