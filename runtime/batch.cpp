// SPDX-License-Identifier: Apache-2.0
#include "runtime/batch.h"

#include <algorithm>
#include <cstring>
#include <new>

namespace rt {

namespace {

constexpr std::size_t alignment = 64;

struct VariableShape {
    int components;
    bool uniform;
};

constexpr int components_of(sl_type type) {
    return type == SL_TYPE_float || type == SL_TYPE_string ? 1 : type == SL_TYPE_matrix ? 16 : 3;
}

constexpr VariableShape variable_shapes[] = {
#define SL_VAR(name, type, detail, readable, writable, note)                                       \
    {components_of(SL_TYPE_##type), SL_DETAIL_##detail == SL_DETAIL_uniform},
#include "runtime/abi/sl_variables.def"
#undef SL_VAR
};

constexpr std::size_t round_up(std::size_t n, std::size_t to) {
    return (n + to - 1) / to * to;
}

std::size_t floats_of(int id, std::uint32_t stride) {
    const VariableShape& shape = variable_shapes[id];
    return static_cast<std::size_t>(shape.components) * (shape.uniform ? 1 : stride);
}

std::size_t elements_of(const sl_param& p) {
    return static_cast<std::size_t>(std::max(p.array_length, 1)) *
           static_cast<std::size_t>(components_of(static_cast<sl_type>(p.type)));
}

// With the differences at the auxiliary points, which are 0 until the engine fills them.
std::size_t num_planes(const sl_param& p) {
    return elements_of(p) * (p.needs_aux != 0 ? 3 : 1);
}

} // namespace

// Byte offsets of everything in the one block of memory; a first pass sizes it, a second one points
// into it.
struct ShadeBatch::Layout {
    std::size_t size = 0;
    std::size_t var[SL_VAR_COUNT] = {};
    std::size_t aux_u[SL_VAR_COUNT] = {};
    std::size_t aux_v[SL_VAR_COUNT] = {};
    std::size_t params = 0;
    std::size_t param_planes = 0;
    std::size_t seeds = 0;
    std::size_t lit = 0;
    std::size_t frames = 0;

    std::size_t add(std::size_t bytes) {
        const std::size_t at = size;
        size += round_up(bytes, alignment);
        return at;
    }

    void add_variables(const sl_object& object, std::uint32_t stride) {
        const std::uint64_t both = object.needed | object.written;
        for (int id = 0; id < SL_VAR_COUNT; ++id) {
            const std::size_t bytes = floats_of(id, stride) * sizeof(float);
            if (both >> id & 1U) {
                var[id] = add(bytes);
            }
            if ((object.needed_aux | object.written_aux) >> id & 1U) {
                aux_u[id] = add(bytes);
                aux_v[id] = add(bytes);
            }
        }
    }
};

void ShadeBatch::AlignedDelete::operator()(std::byte* p) const {
    ::operator delete[](p, std::align_val_t{alignment});
}

void ShadeBatch::begin(const ShaderInstance& instance, std::uint32_t count) {
    instance_ = &instance;
    const sl_object& object = instance.object();
    const sl_variant& variant = instance.shader().variant();
    lanes_ = static_cast<std::uint32_t>(variant.lanes);
    batch_ = {};
    batch_.count = std::clamp<std::uint32_t>(count, 1, SL_BATCH_MAX);
    batch_.stride = static_cast<std::uint32_t>(round_up(batch_.count, SL_LANES_MAX));
    finished_.assign(num_packets(), false);

    Layout layout;
    layout.add_variables(object, batch_.stride);
    layout.params = layout.add(object.params_size);
    layout.param_planes = layout.size;
    for (int i = 0; i < object.num_params; ++i) {
        const sl_param& p = object.params[i];
        if (p.detail == SL_DETAIL_varying) {
            const std::size_t unit = p.type == SL_TYPE_string ? sizeof(sl_string) : sizeof(float);
            layout.add(num_planes(p) * batch_.stride * unit);
        }
    }
    layout.seeds = layout.add(batch_.stride * sizeof(std::uint32_t));
    layout.lit = layout.add(num_packets() * sizeof(std::uint32_t));
    frame_stride_ =
        round_up(variant.frame_size, std::max<std::size_t>(variant.frame_align, alignment));
    layout.frames = layout.add(frame_stride_ * num_packets());

    if (layout.size > capacity_) {
        capacity_ = round_up(layout.size + layout.size / 2, 4096);
        memory_.reset(
            static_cast<std::byte*>(::operator new[](capacity_, std::align_val_t{alignment})));
    }
    // Zero everywhere: the lanes past `count` must be harmless, and clearing all is cheaper than
    // finding them.
    std::memset(memory_.get(), 0, layout.frames);
    point_to(layout, memory_.get());
    bind_params(layout, memory_.get());
    begin_frames();
}

// All a shader needs of a new frame is its state.
void ShadeBatch::begin_frames() {
    for (std::uint32_t packet = 0; frame_stride_ > 0 && packet < num_packets(); ++packet) {
        reinterpret_cast<sl_frame*>(frames_ + packet * frame_stride_)->state = 0;
    }
}

void ShadeBatch::point_to(const Layout& layout, std::byte* memory) {
    const sl_object& object = instance_->object();
    main_ = {};
    aux_u_ = {};
    aux_v_ = {};
    for (int id = 0; id < SL_VAR_COUNT; ++id) {
        if ((object.needed | object.written) >> id & 1U) {
            main_.var[id] = reinterpret_cast<float*>(memory + layout.var[id]);
        }
        if ((object.needed_aux | object.written_aux) >> id & 1U) {
            aux_u_.var[id] = reinterpret_cast<float*>(memory + layout.aux_u[id]);
            aux_v_.var[id] = reinterpret_cast<float*>(memory + layout.aux_v[id]);
        }
    }
    seeds_ = reinterpret_cast<std::uint32_t*>(memory + layout.seeds);
    lit_ = reinterpret_cast<std::uint32_t*>(memory + layout.lit);
    frames_ = memory + layout.frames;

    const bool has_aux = (object.needed_aux | object.written_aux) != 0;
    batch_.main = &main_;
    batch_.aux_u = has_aux ? &aux_u_ : nullptr;
    batch_.aux_v = has_aux ? &aux_v_ : nullptr;
    batch_.params = memory + layout.params;
    batch_.strings = instance_->shader().strings().data();
    batch_.seed = seeds_;
    batch_.lit = lit_;
}

void ShadeBatch::bind_params(const Layout& layout, std::byte* memory) {
    const sl_object& object = instance_->object();
    auto* block = static_cast<std::byte*>(batch_.params);
    std::copy(instance_->params().begin(), instance_->params().end(), block); // may be empty
    std::size_t at = layout.param_planes;
    for (int i = 0; i < object.num_params; ++i) {
        const sl_param& p = object.params[i];
        if (p.detail != SL_DETAIL_varying) {
            continue;
        }
        std::byte* planes = memory + at;
        spread(p, planes);
        const std::size_t unit = p.type == SL_TYPE_string ? sizeof(sl_string) : sizeof(float);
        at += round_up(num_planes(p) * batch_.stride * unit, alignment);
        std::memcpy(block + p.offset, &planes, sizeof planes);
    }
}

// The staged value to every point.
void ShadeBatch::spread(const sl_param& p, std::byte* planes) {
    const std::byte* staged = slot(p) + 16;
    const auto fill = [&](auto* to, const auto* from) {
        for (std::size_t k = 0; k < elements_of(p); ++k) {
            std::fill_n(to + k * batch_.stride, batch_.stride, from[k]);
        }
    };
    if (p.type == SL_TYPE_string) {
        fill(reinterpret_cast<sl_string*>(planes), reinterpret_cast<const sl_string*>(staged));
    } else {
        fill(reinterpret_cast<float*>(planes), reinterpret_cast<const float*>(staged));
    }
}

void ShadeBatch::restart() {
    const sl_object& object = instance_->object();
    finished_.assign(num_packets(), false);
    std::fill_n(lit_, num_packets(), 0U);
    begin_frames();
    for (int i = 0; i < object.num_params; ++i) {
        const sl_param& p = object.params[i];
        if (p.is_output == 0) {
            continue;
        }
        if (p.detail == SL_DETAIL_varying) {
            spread(p, *reinterpret_cast<std::byte**>(slot(p)));
        } else {
            const std::size_t unit = p.type == SL_TYPE_string ? sizeof(sl_string) : sizeof(float);
            std::memcpy(slot(p), instance_->params().data() + p.offset, elements_of(p) * unit);
        }
    }
}

const sl_param* ShadeBatch::param(int index, bool varying, bool string) const {
    const sl_object& object = instance_->object();
    if (index < 0 || index >= object.num_params) {
        return nullptr;
    }
    const sl_param& p = object.params[index];
    const bool matches =
        (p.detail == SL_DETAIL_varying) == varying && (p.type == SL_TYPE_string) == string;
    return matches ? &p : nullptr;
}

std::byte* ShadeBatch::slot(const sl_param& p) const {
    return static_cast<std::byte*>(batch_.params) + p.offset;
}

float* ShadeBatch::param_plane(int index, int component) {
    const sl_param* p = param(index, true, false);
    return p ? plane_of(*reinterpret_cast<float**>(slot(*p)), component) : nullptr;
}

float* ShadeBatch::param_aux(int index, int point, int component) {
    const sl_param* p = param(index, true, false);
    if (p == nullptr || p->needs_aux == 0) {
        return nullptr;
    }
    return param_plane(index, static_cast<int>(elements_of(*p)) * point + component);
}

sl_string* ShadeBatch::param_strings(int index) {
    const sl_param* p = param(index, true, true);
    return p ? *reinterpret_cast<sl_string**>(slot(*p)) : nullptr;
}

float* ShadeBatch::param_uniform(int index) {
    const sl_param* p = param(index, false, false);
    return p ? reinterpret_cast<float*>(slot(*p)) : nullptr;
}

sl_string* ShadeBatch::param_uniform_string(int index) {
    const sl_param* p = param(index, false, true);
    return p ? reinterpret_cast<sl_string*>(slot(*p)) : nullptr;
}

void ShadeBatch::bind(const ShadeContext& context) {
    batch_.services = context.services;
    batch_.engine = context.engine;
}

std::uint32_t ShadeBatch::run(const ShadeContext& context) {
    bind(context);
    const sl_variant& variant = instance_->shader().variant();
    std::uint32_t num_suspended = 0;
    for (std::uint32_t packet = 0; packet < num_packets(); ++packet) {
        if (finished_[packet]) {
            continue;
        }
        const std::uint32_t first = packet * lanes_;
        auto* frame = frame_stride_ > 0
                          ? reinterpret_cast<sl_frame*>(frames_ + packet * frame_stride_)
                          : nullptr;
        const sl_status status =
            variant.shade(&batch_, first, std::min(lanes_, batch_.count - first), frame);
        finished_[packet] = status == SL_DONE;
        num_suspended += status == SL_DONE ? 0 : 1;
    }
    return num_suspended;
}

sl_ray_query* ShadeBatch::request(std::uint32_t packet) {
    if (packet >= finished_.size() || finished_[packet] || frame_stride_ == 0) {
        return nullptr;
    }
    return &reinterpret_cast<sl_frame*>(frames_ + packet * frame_stride_)->rays;
}

} // namespace rt
