// SPDX-License-Identifier: Apache-2.0
// One .slo file becomes one ShaderObject. The only caller of dlopen on files that users name.
// The seal (base/seal.h) is checked on the bytes of the file first: a wrong fingerprint, a
// truncated or a damaged file never reaches the dynamic linker. The descriptor is checked after it
// (descriptor_check.h). Objects that are no files (members of packages, results that no
// cache keeps) are mapped from anonymous memory.
#include "runtime/base/file.h"
#include "runtime/base/seal.h"
#include "runtime/descriptor_check.h"
#include "runtime/shader.h"
#include "sl_fingerprint.h"

#include <cerrno>
#include <cstring>
#include <dlfcn.h>
#include <sys/mman.h>

namespace rt {

namespace {

bool runs_here(const sl_variant& variant) {
    switch (variant.isa) {
    case SL_ISA_any:
        return true;
    case SL_ISA_avx2:
        return __builtin_cpu_supports("avx2") != 0;
    default:
        return false;
    }
}

const sl_variant* best_variant(const sl_object& object) {
    for (int i = 0; i < object.num_variants; ++i) {
        if (runs_here(*object.variants[i])) {
            return object.variants[i];
        }
    }
    return nullptr;
}

// Empty: sealed well, and `content` names what it holds.
std::string why_not_sealed(std::string_view bytes, std::string& content) {
    switch (base::check_seal(bytes, SL_ABI_FINGERPRINT)) {
    case base::SealState::Good:
        content = base::sealed_hash(bytes);
        return {};
    case base::SealState::Missing:
        return "is no shader object of slc, or is truncated";
    case base::SealState::Damaged:
        return "is damaged: its content does not match its seal";
    case base::SealState::OtherFingerprint:
        return "was compiled by another version of slc (its ABI fingerprint differs); compile it "
               "again";
    }
    return "cannot be checked";
}

// Bytes as a file without a name. The dynamic linker knows objects by the path they were opened
// with, here /proc/self/fd/N: the descriptor stays open as long as the object, so that no other one
// gets its number.
base::Descriptor memory_file(std::string_view bytes, std::string& why) {
    base::Descriptor file(::memfd_create("shader", MFD_CLOEXEC));
    if (!file.is_open() || !base::write_all(file.get(), bytes)) {
        why = std::string("cannot be put into memory: ") + std::strerror(errno);
        file.reset();
    }
    return file;
}

} // namespace

std::unique_ptr<ShaderObject> ShaderObject::open(const std::string& slo_path, StringTable& strings,
                                                 std::string& why) {
    const auto bytes = base::read_file(slo_path);
    std::string content;
    why = bytes ? why_not_sealed(*bytes, content) : "cannot be read";
    if (!why.empty()) {
        return nullptr;
    }
    std::unique_ptr<ShaderObject> shader(new ShaderObject);
    shader->content_ = std::move(content);
    // dlopen searches the system's libraries for names without a slash.
    return shader->link(slo_path.find('/') == std::string::npos ? "./" + slo_path : slo_path,
                        strings, why)
               ? std::move(shader)
               : nullptr;
}

std::unique_ptr<ShaderObject> ShaderObject::open_bytes(std::string_view bytes, StringTable& strings,
                                                       std::string& why) {
    std::unique_ptr<ShaderObject> shader(new ShaderObject);
    why = why_not_sealed(bytes, shader->content_);
    if (why.empty()) {
        shader->memory_ = memory_file(bytes, why);
    }
    return why.empty() && shader->link("/proc/self/fd/" + std::to_string(shader->memory_.get()),
                                       strings, why)
               ? std::move(shader)
               : nullptr;
}

bool ShaderObject::link(const std::string& file, StringTable& strings, std::string& why) {
    handle_ = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!handle_) {
        const char* reason = ::dlerror();
        why = std::string("cannot be loaded: ") + (reason ? reason : "unknown reason");
        return false;
    }
    const auto* object = static_cast<const sl_object*>(::dlsym(handle_, "sl_shader_object"));
    if (!object) {
        why = "exports no sl_shader_object";
        return false;
    }
    why = why_not_sound(*object, ObjectImage::around(object));
    return why.empty() && take(*object, strings, why);
}

std::unique_ptr<ShaderObject> ShaderObject::adopt(const sl_object& object, StringTable& strings,
                                                  std::string& why) {
    std::unique_ptr<ShaderObject> shader(new ShaderObject);
    why = why_not_sound(object, {}); // linked into the program
    return why.empty() && shader->take(object, strings, why) ? std::move(shader) : nullptr;
}

bool ShaderObject::take(const sl_object& object, StringTable& strings, std::string& why) {
    if (std::strcmp(object.fingerprint, SL_ABI_FINGERPRINT) != 0) {
        why = "does not carry this version's ABI fingerprint; compile it again";
        return false;
    }
    object_ = &object;
    variant_ = best_variant(object);
    if (!variant_) {
        why = "has no code for this processor (no AVX2 here); compile it again on this machine";
        return false;
    }
    for (int i = 0; i < object.num_strings; ++i) {
        strings_.push_back(strings.intern(object.strings[i]));
    }
    return true;
}

ShaderObject::~ShaderObject() {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) // reports must name shader code
    if (handle_) {
        ::dlclose(handle_);
    }
#else
    memory_.release(); // its number must not be used again
#endif
}

int ShaderObject::find_param(std::string_view name) const {
    for (int i = 0; i < object_->num_params; ++i) {
        if (object_->params[i].name == name) {
            return i;
        }
    }
    return -1;
}

} // namespace rt
