// SPDX-License-Identifier: Apache-2.0
#include "tracer/frame_hash.h"

#include "ribtools/scene_hash.h"
#include "runtime/base/sha256.h"
#include "tracer/version.h"

#include <cstring>
#include <elf.h>
#include <link.h>
#include <string>
#include <string_view>

namespace trace {

namespace {

constexpr std::string_view gnu_owner("GNU\0", 4);

// The notes of one segment: owner and description are padded to words.
std::string_view build_id_in(const char* at, std::size_t size) {
    const auto padded = [](std::size_t n) { return (n + 3) & ~std::size_t{3}; };
    while (size >= sizeof(ElfW(Nhdr))) {
        ElfW(Nhdr) note;
        std::memcpy(&note, at, sizeof note);
        const std::size_t length = sizeof note + padded(note.n_namesz) + padded(note.n_descsz);
        if (length > size) {
            break;
        }
        const std::string_view owner(at + sizeof note, note.n_namesz);
        if (note.n_type == NT_GNU_BUILD_ID && owner == gnu_owner) {
            return {at + sizeof note + padded(note.n_namesz), note.n_descsz};
        }
        at += length;
        size -= length;
    }
    return {};
}

// The linker's hash of this very program: development builds share a version number.
std::string program_build_id() {
    std::string id;
    dl_iterate_phdr(
        [](dl_phdr_info* info, std::size_t, void* out) {
            for (int i = 0; i < info->dlpi_phnum; ++i) {
                const ElfW(Phdr)& segment = info->dlpi_phdr[i];
                if (segment.p_type == PT_NOTE) {
                    const auto* notes =
                        reinterpret_cast<const char*>(info->dlpi_addr + segment.p_vaddr);
                    *static_cast<std::string*>(out) += build_id_in(notes, segment.p_memsz);
                }
            }
            return 1; // the program itself comes first; its libraries do not matter
        },
        &id);
    return id;
}

} // namespace

std::array<std::uint8_t, 32> frame_hash(const rib::Scene& scene, const ShaderSet& shaders) {
    base::Sha256 sha;
    sha.add_field(renderer_version_text);
    sha.add_field(program_build_id());
    sha.add_field(rib::scene_hash(scene));
    for (rib::ShaderId id = 0; id < scene.shaders.size(); ++id) {
        const ShaderEntry* entry = shaders.get(id);
        const rt::ShaderObject* shader = entry != nullptr ? &entry->instance->shader() : nullptr;
        sha.add_field(shader != nullptr ? shader->content() : "");
        sha.add_field(std::to_string(shader != nullptr ? shader->variant().isa : -1));
    }
    return sha.digest();
}

} // namespace trace
