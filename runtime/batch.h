// SPDX-License-Identifier: Apache-2.0
// Memory for shading up to SL_BATCH_MAX points with one shader instance. The engine calls begin(),
// fills the planes the shader asks for, calls run() and reads the planes the shader wrote. One
// ShadeBatch per thread and nesting level, reused: memory only grows. Planes are laid out as
// sl_abi.h says; lanes past `count` are zero. Values live until the next begin().
#pragma once

#include "runtime/shader.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace rt {

// What the engine serves the batch with; all of it is handed through to the shader.
struct ShadeContext {
    const sl_services* services = nullptr;
    void* engine = nullptr;
};

class ShadeBatch {
public:
    ShadeBatch() = default;
    ShadeBatch(const ShadeBatch&) = delete;
    ShadeBatch& operator=(const ShadeBatch&) = delete;

    // Lays out `count` points (1 .. SL_BATCH_MAX) for an instance, which must outlive the batch's
    // use. Parameters hold the instance's values: varying and output ones are spread over their
    // planes.
    void begin(const ShaderInstance& instance, std::uint32_t count);

    // The same points and layout once more, for callers that run one instance many times (lights):
    // all packets are to be done again, lit words are cleared, output parameters hold their bound
    // values. Variables and other parameters stay as they are.
    void restart();

    [[nodiscard]] std::uint32_t count() const { return batch_.count; }
    [[nodiscard]] std::uint32_t stride() const { return batch_.stride; }
    [[nodiscard]] const ShaderInstance& instance() const { return *instance_; }

    // All planes, for geo::World::fill; the auxiliary records are null if the shader has no use for
    // them.
    [[nodiscard]] const sl_points& points() const { return main_; }
    [[nodiscard]] const sl_points* aux_points_u() const { return batch_.aux_u; }
    [[nodiscard]] const sl_points* aux_points_v() const { return batch_.aux_v; }

    // True if the shader needs or writes the variable: then its planes exist.
    [[nodiscard]] bool has(sl_variable id) const { return main_.var[id] != nullptr; }
    // Plane k of a varying variable; null if !has(id).
    [[nodiscard]] float* plane(sl_variable id, int component = 0) {
        return plane_of(main_.var[id], component);
    }
    // The components of a variable that is uniform in sl_variables.def (E, ncomps); null if
    // !has(id).
    [[nodiscard]] float* uniform(sl_variable id) { return main_.var[id]; }
    // Differences X(u+du,v) - X(u,v) and X(u,v+dv) - X(u,v) of the variables in needed_aux and
    // written_aux; null otherwise.
    [[nodiscard]] float* aux_u(sl_variable id, int component = 0) {
        return plane_of(aux_u_.var[id], component);
    }
    [[nodiscard]] float* aux_v(sl_variable id, int component = 0) {
        return plane_of(aux_v_.var[id], component);
    }

    // A varying parameter's plane (component counts through array elements), to bind a primitive
    // variable or read an output; null when the parameter is uniform or no number.
    [[nodiscard]] float* param_plane(int param, int component = 0);
    // The same for its differences at auxiliary point 1 (u + du) or 2 (v + dv); null unless the
    // shader asks for them (sl_param.needs_aux).
    [[nodiscard]] float* param_aux(int param, int point, int component = 0);
    // A varying string parameter: one per point. Null otherwise.
    [[nodiscard]] sl_string* param_strings(int param);
    // A uniform parameter's value in this batch's copy: array_length * components floats (null:
    // varying or string).
    [[nodiscard]] float* param_uniform(int param);
    [[nodiscard]] sl_string* param_uniform_string(int param);

    // Per point: the source of random().
    [[nodiscard]] std::uint32_t* seeds() { return seeds_; }
    // Lights: bit i % lanes of word i / lanes is set when point i executed illuminate or solar.
    [[nodiscard]] bool lit(std::uint32_t point) const {
        return (lit_[point / lanes_] >> (point % lanes_) & 1U) != 0;
    }
    [[nodiscard]] const std::uint32_t* lit_words() const { return lit_; }

    // What serves packets that somebody else runs (raw()).
    void bind(const ShadeContext& context);
    // Shades every packet that is not finished and returns how many are suspended afterwards: 0
    // when the batch is done. Answer request() of those, then call run() again.
    std::uint32_t run(const ShadeContext& context);
    [[nodiscard]] std::uint32_t num_packets() const { return (batch_.count + lanes_ - 1) / lanes_; }
    // What the shader is handed; services and engine are those of the last run().
    [[nodiscard]] const sl_batch& raw() const { return batch_; }
    // The pending request of a packet, or null if it is finished.
    [[nodiscard]] sl_ray_query* request(std::uint32_t packet);

private:
    struct Layout;
    void point_to(const Layout& layout, std::byte* memory);
    void begin_frames();
    void bind_params(const Layout& layout, std::byte* memory);
    void spread(const sl_param& p, std::byte* planes);
    [[nodiscard]] float* plane_of(float* base, int component) const {
        return base ? base + static_cast<std::size_t>(component) * batch_.stride : nullptr;
    }
    [[nodiscard]] const sl_param* param(int index, bool varying, bool string) const;
    [[nodiscard]] std::byte* slot(const sl_param& p) const;

    struct AlignedDelete {
        void operator()(std::byte* p) const;
    };
    std::unique_ptr<std::byte[], AlignedDelete> memory_;
    std::size_t capacity_ = 0;
    const ShaderInstance* instance_ = nullptr;
    sl_points main_{};
    sl_points aux_u_{};
    sl_points aux_v_{};
    sl_batch batch_{};
    std::uint32_t* seeds_ = nullptr;
    std::uint32_t* lit_ = nullptr;
    std::uint32_t lanes_ = 8;
    std::byte* frames_ = nullptr;
    std::size_t frame_stride_ = 0;
    std::vector<bool> finished_; // per packet
};

} // namespace rt
