// SPDX-License-Identifier: Apache-2.0
// The shaders of a frame, loaded and bound. In: the scene's shader calls. Out: one instance per
// call, with its parameters in camera space (sl.md 5.8: values of a call lie in the space of the
// call). A surface that cannot be had is replaced by the built-in default surface after one
// message; other shaders are left out. Immutable once made.
#pragma once

#include "ribtools/backend.h"
#include "ribtools/scene.h"
#include "runtime/shader.h"
#include "tracer/spaces.h"
#include "tracer/stats.h"

#include <atomic>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

namespace trace {

struct ShaderEntry {
    std::string name;
    std::uint32_t number = 0;                     // of its shader in ShaderSet::names()
    std::unique_ptr<rt::ShaderInstance> instance; // never null in a finished set
    base::Mat4 camera_from_shader;
    base::SourcePos pos;
    // The instance for its parameters alone, once there is one, and the time spent in either
    // (specialise.h); all else about the entry never changes.
    mutable std::atomic<const rt::ShaderInstance*> special{nullptr};
    mutable std::atomic<std::uint64_t> spent_ticks{0};

    // What runs now: asked once per batch.
    [[nodiscard]] const rt::ShaderInstance& current() const {
        const rt::ShaderInstance* made = special.load(std::memory_order_acquire);
        return made != nullptr ? *made : *instance;
    }
    [[nodiscard]] const sl_object& object() const { return instance->object(); }
};

// What instances are made with and from.
struct ShaderSources {
    const rib::Scene& scene;
    const Spaces& spaces;
    rt::ShaderLibrary& library;
    rt::StringTable& strings;
    base::Diag& diag;
};

class ShaderSet {
public:
    // Loads every shader that something drawn refers to.
    explicit ShaderSet(const ShaderSources& sources);
    ~ShaderSet();

    // nullptr: none given, missing, broken or "null" where that means nothing to do.
    [[nodiscard]] const ShaderEntry* get(rib::ShaderId id) const {
        return id < entries_.size() ? entries_[id] : nullptr;
    }
    // Never nullptr.
    [[nodiscard]] const ShaderEntry* surface(rib::ShaderId id) const {
        const ShaderEntry* entry = get(id);
        return entry != nullptr ? entry : default_surface_;
    }
    // The shaders that instances were made of; statistics are kept per shader.
    [[nodiscard]] const std::vector<ShaderName>& names() const { return names_; }

private:
    void load(const ShaderSources& sources, rib::ShaderId id, sl_shader_type type,
              bool in_camera_space);
    const ShaderEntry* add(std::unique_ptr<ShaderEntry> entry);
    [[nodiscard]] const ShaderEntry* shareable(const rib::Scene& scene, rib::ShaderId id) const;

    std::vector<std::unique_ptr<ShaderEntry>> owned_;
    std::vector<const ShaderEntry*> entries_; // by ShaderId
    std::vector<bool> tried_;
    std::vector<ShaderName> names_;
    std::unordered_map<const sl_object*, std::uint32_t> number_of_object_;
    const ShaderEntry* default_surface_ = nullptr;
};

// No name, or "null": no shader, unless it is a surface.
[[nodiscard]] bool is_null_shader(const rib::ShaderCall& call);

// A parameter of a request as a shader of this interface binds it: points, vectors, normals and
// matrices taken from `space` to camera space, hpoints divided; a name that was never declared
// takes its type from the shader. Pure.
[[nodiscard]] rt::BoundValue bound_value(const rib::Param& param, const sl_object& object,
                                         const Space& space);

} // namespace trace
