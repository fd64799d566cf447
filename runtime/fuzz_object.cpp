// SPDX-License-Identifier: Apache-2.0
// Fuzz target: what the loader checks before it trusts a shader object. The first byte chooses:
// bytes as a sealed file, bytes as a package, or bytes as the memory of an object whose descriptor
// lies at its start, with pointers to anywhere.
#include "runtime/base/ar_file.h"
#include "runtime/base/file.h"
#include "runtime/base/fuzz.h"
#include "runtime/base/seal.h"
#include "runtime/descriptor_check.h"

#include <cstdlib>
#include <cstring>
#include <sys/mman.h>

namespace {

void check_sealed(std::string_view bytes) {
    const std::string fingerprint(64, 'f');
    if (base::check_seal(bytes, fingerprint) == base::SealState::Good &&
        base::sealed_hash(bytes).size() != 64) {
        std::abort();
    }
    const std::string sealed = std::string(bytes) + base::seal(bytes, fingerprint);
    if (base::check_seal(sealed, fingerprint) != base::SealState::Good) {
        std::abort();
    }
}

void read_package(std::string_view bytes) {
    const base::Descriptor file(::memfd_create("package", MFD_CLOEXEC));
    if (!base::write_all(file.get(), bytes)) {
        return;
    }
    std::string why;
    const auto package = base::ArFile::open("/proc/self/fd/" + std::to_string(file.get()), why);
    for (const std::string& name : package ? package->names() : std::vector<std::string>()) {
        const auto content = package->read(name);
        if (content && content->size() > bytes.size()) {
            std::abort();
        }
    }
}

void read_all(const sl_object& o) {
    std::size_t sum = std::strlen(o.fingerprint) + std::strlen(o.name);
    for (int i = 0; i < o.num_params; ++i) {
        const sl_param& p = o.params[i];
        sum += std::strlen(p.name);
        if (p.offset >= o.params_size) {
            std::abort();
        }
    }
    for (int i = 0; i < o.num_strings; ++i) {
        sum += std::strlen(o.strings[i]);
    }
    for (int i = 0; i < o.num_variants; ++i) {
        sum += static_cast<std::size_t>(o.variants[i]->lanes);
    }
    if (sum == 0) { // names are not empty
        std::abort();
    }
}

// Words that begin with 0x7f are offsets into the bytes, so that pointers lead somewhere.
void check_object(std::string_view bytes) {
    std::vector<std::uint64_t> words(bytes.size() / 8);
    if (words.size() * 8 < sizeof(sl_object)) {
        return;
    }
    std::memcpy(words.data(), bytes.data(), words.size() * 8);
    const auto begin = reinterpret_cast<std::uintptr_t>(words.data());
    for (std::uint64_t& word : words) {
        if (word >> 56 == 0x7f) {
            word = begin + (word & 0xffffff);
        }
    }
    const rt::ObjectImage image{{{begin, begin + words.size() * 8}},
                                {{begin, begin + words.size() * 8}}};
    const auto& object = *reinterpret_cast<const sl_object*>(words.data());
    if (rt::why_not_sound(object, image).empty()) {
        read_all(object); // the sanitizer watches
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) {
        return 0;
    }
    const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
    switch (data[0] % 3) {
    case 0:
        check_sealed(bytes);
        break;
    case 1:
        read_package(bytes);
        break;
    default:
        check_object(bytes);
        break;
    }
    return 0;
}
