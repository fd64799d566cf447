// SPDX-License-Identifier: Apache-2.0
// State: blocks that save and restore, worlds that become scenes, motion blocks (ri.md
// 5, 6.2, 12.3).
#include "ribtools/state_impl.h"

#include <algorithm>

namespace rib {

void State::open(BlockKind kind, const Request& request) {
    auto saved = std::make_unique<Saved>();
    if (kind != BlockKind::Motion && kind != BlockKind::Resource) {
        saved->transform = transform_;
        saved->solid = current_solid_;
        if (kind != BlockKind::Transform) {
            saved->attributes = attributes_;
            saved->edit = current_edit_;
        }
    }
    if (kind == BlockKind::Frame || kind == BlockKind::World) {
        saved->stream = std::make_unique<Saved::Stream>(
            Saved::Stream{options_, std::make_unique<Scene>(*scene_), objects_, light_handles_,
                          object_handles_, screen_from_camera_extra_, host_.num_archives()});
    }
    if (kind == BlockKind::Resource) {
        saved->resources = std::make_unique<decltype(resources_)>(resources_);
    }
    blocks_.push(kind, request.pos);
    saved_.push_back(std::move(saved));
}

// Puts back what the innermost block saved and removes it.
void State::restore(BlockKind kind) {
    Saved& saved = *saved_.back();
    if (saved.attributes) {
        attributes_ = std::move(*saved.attributes);
        current_edit_ = saved.edit;
    }
    if (saved.transform) {
        transform_ = std::move(*saved.transform);
        current_solid_ = saved.solid;
    }
    if (saved.stream) {
        if (kind == BlockKind::Frame) {
            options_ = std::move(saved.stream->options);
        }
        scene_ = std::move(saved.stream->scene);
        objects_ = std::move(saved.stream->objects);
        light_handles_ = std::move(saved.stream->light_handles);
        object_handles_ = std::move(saved.stream->object_handles);
        screen_from_camera_extra_ = saved.stream->screen_from_camera_extra;
        host_.forget_archives(saved.stream->num_archives);
        forget_indices();
        solid_operands_.clear();
    }
    if (saved.resources) {
        resources_ = std::move(*saved.resources);
    }
    saved_.pop_back();
    blocks_.pop();
}

bool State::close(BlockKind kind, const Request& request) {
    const std::size_t depth = blocks_.find(kind);
    // A stray end inside a world must not take the world with it.
    const bool is_outer = kind == BlockKind::World || kind == BlockKind::Frame;
    const std::size_t fence =
        is_outer ? 0
                 : std::max({blocks_.find(BlockKind::World), blocks_.find(BlockKind::Frame),
                             blocks_.find(BlockKind::Object)});
    if (depth == 0 || depth < fence) {
        error(base::Code::Nesting, request,
              "no " + std::string(block_name(kind)) + "Begin is open; ignored");
        return false;
    }
    while (blocks_.depth() > depth) {
        const Blocks::Block block = blocks_.top();
        diag_.report(base::Severity::Error, base::Code::Nesting, request.pos,
                     std::string(row(request.id).name) + ": the " +
                         std::string(block_name(block.kind)) + "Begin of " +
                         base::place_name(block.pos) + " is still open; closed here");
        if (block.kind == BlockKind::Object) {
            finish_object();
        }
        restore(block.kind);
    }
    return true;
}

void State::close_blocks(base::SourcePos end, std::size_t keep, bool tell) {
    const std::size_t max_told = tell ? 20 : 0;
    const std::size_t num_open = blocks_.depth() - std::min(keep, blocks_.depth());
    refused_blocks_ = 0;
    for (std::size_t i = 0; i < num_open; ++i) {
        const Blocks::Block block = blocks_.top();
        if (i < max_told || (tell && block.kind == BlockKind::World)) {
            diag_.report(
                base::Severity::Error, base::Code::Nesting, end,
                "end of input inside the " + std::string(block_name(block.kind)) + "Begin of " +
                    base::place_name(block.pos) +
                    (block.kind == BlockKind::World ? "; the world is not rendered" : "; closed"));
        }
        if (block.kind == BlockKind::Object) {
            finish_object();
        }
        restore(block.kind);
    }
    if (tell && num_open > max_told) {
        diag_.report(base::Severity::Error, base::Code::Nesting, end,
                     "end of input: " + std::to_string(num_open) + " blocks were open");
    }
}

void State::do_FrameBegin(Request& request) {
    open(BlockKind::Frame, request);
    options_.frame = request.args[0].given ? request.integer(0) : 0;
    options_.in_frame = true;
}

void State::do_FrameEnd(Request& request) {
    if (close(BlockKind::Frame, request)) {
        restore(BlockKind::Frame);
    }
}

void State::do_AttributeBegin(Request& request) {
    open(BlockKind::Attribute, request);
}

void State::do_AttributeEnd(Request& request) {
    if (close(BlockKind::Attribute, request)) {
        restore(BlockKind::Attribute);
    }
}

void State::do_TransformBegin(Request& request) {
    open(BlockKind::Transform, request);
}

void State::do_TransformEnd(Request& request) {
    if (close(BlockKind::Transform, request)) {
        restore(BlockKind::Transform);
    }
}

void State::do_ResourceBegin(Request& request) {
    open(BlockKind::Resource, request);
}

void State::do_ResourceEnd(Request& request) {
    if (close(BlockKind::Resource, request)) {
        restore(BlockKind::Resource);
    }
}

// --- worlds ---

void State::do_WorldBegin(Request& request) {
    open(BlockKind::World, request);
    scene_->options = options_;
    if (config_.override_options) {
        config_.override_options(scene_->options);
    }
    resolve_options();
    world_wanted_ = !config_.wants_world || config_.wants_world(scene_->options);
    scene_->camera_from_world = transform_.value;
    scene_->screen_from_camera_extra = screen_from_camera_extra_;
    if (!inverse(transform_.value)) {
        error(base::Code::Math, request,
              "the camera transformation has no inverse; an identity is used");
        scene_->camera_from_world = Transform();
    }
    scene_->camera_exterior = attributes_.value.exterior;
    bring_into_world();
    transform_ = {Transform(), none};
}

// Defaults that depend on other options (ri.md 6.3).
void State::resolve_options() {
    Options& o = scene_->options;
    declare_outputs(o);
    if (!o.has_screen_window) {
        const float viewport_aspect =
            static_cast<float>(o.xres) * o.pixel_aspect / static_cast<float>(o.yres);
        const float f = o.frame_aspect > 0 ? o.frame_aspect : viewport_aspect;
        o.screen_window = f >= 1 ? std::array<float, 4>{-f, f, -1, 1}
                                 : std::array<float, 4>{-1, 1, -1 / f, 1 / f};
    }
}

// What was placed relative to the camera before the world began, save lights, gets its place in the
// world.
void State::bring_into_world() {
    const Transform world_from_camera = *inverse(scene_->camera_from_world);
    std::vector<bool> is_light(scene_->shaders.size());
    for (const Light& light : scene_->lights) {
        is_light[light.shader] = true;
    }
    std::unordered_map<TransformId, TransformId> moved;
    const auto move = [&](TransformId& id) {
        const auto [it, is_new] = moved.try_emplace(id, none);
        if (is_new) {
            it->second = add_transform(world_from_camera * scene_->transforms[id]);
        }
        id = it->second;
    };
    for (std::size_t i = 0; i < scene_->shaders.size(); ++i) {
        if (!is_light[i] && i != scene_->options.imager) {
            move(scene_->shaders[i].world_from_shader);
        }
    }
    for (auto& [name, id] : scene_->coordinate_systems) {
        move(id);
    }
    const base::Mat4& camera_from_world = scene_->camera_from_world.still();
    for (Options::ClippingPlane& plane : scene_->options.clipping_planes) {
        const base::Mat4& world_from_cam = world_from_camera.still();
        const auto& [px, py, pz] = plane.point_world;
        const auto& [nx, ny, nz] = plane.normal_world;
        const base::V3d P_world = base::point(world_from_cam, {px, py, pz});
        const base::V3d n_world = base::normal_by_inverse(camera_from_world, {nx, ny, nz});
        plane = {{P_world.x, P_world.y, P_world.z}, {n_world.x, n_world.y, n_world.z}};
    }
    if (!attributes_.value.scoped_systems.empty()) {
        for (auto& [name, id] : edit_attributes().scoped_systems.edit()) {
            move(id);
        }
    }
    forget_indices();
}

void State::do_WorldEnd(Request& request) {
    if (close(BlockKind::World, request)) {
        end_world(world_wanted_);
    }
}

void State::end_world(bool render) {
    std::unique_ptr<Scene> scene = std::move(scene_);
    restore(BlockKind::World);
    world_wanted_ = true;
    if (render && !backend_.render(std::move(scene))) {
        stop_ = true;
    }
}

// --- motion blocks (ri.md 12.3) ---

void State::do_MotionBegin(Request& request) {
    open(BlockKind::Motion, request);
    motion_times_ = std::move(request.args[0].floats);
    const Param* offset = nullptr;
    if (const auto it = options_.user.find("shutter:offset"); it != options_.user.end()) {
        offset = &it->second;
    }
    for (float& time : motion_times_) {
        time += offset && !offset->floats.empty() ? offset->floats.front() : 0;
    }
    motion_samples_.clear();
}

void State::do_MotionEnd(Request& request) {
    if (!close(BlockKind::Motion, request)) {
        return;
    }
    restore(BlockKind::Motion);
    std::vector<Request> samples = std::move(motion_samples_);
    std::vector<float> times = std::move(motion_times_);
    motion_samples_.clear();
    motion_times_.clear();
    if (samples.empty()) {
        error(base::Code::BadMotion, request, "the motion block is empty; ignored");
        return;
    }
    bool good = samples.size() == times.size();
    std::string what =
        std::to_string(times.size()) + " times but " + std::to_string(samples.size()) + " requests";
    for (std::size_t i = 1; good && i < samples.size(); ++i) {
        if (samples[i].id != samples[0].id) {
            good = false;
            what = "one block mixes " + std::string(row(samples[0].id).name) + " and " +
                   std::string(row(samples[i].id).name);
        } else if (!(times[i] > times[i - 1])) {
            good = false;
            what = "the times do not increase";
        }
    }
    if (!good) {
        error(base::Code::BadMotion, request, what + "; the first sample is used");
    }
    const RequestKind kind = row(samples[0].id).kind;
    if (!admit(samples[0])) {
        return;
    }
    if (!good || samples.size() == 1 ||
        (kind != RequestKind::Transform && kind != RequestKind::Primitive)) {
        execute(samples[0]); // moving shading: the value at the first time
    } else if (kind == RequestKind::Transform) {
        move_transform(samples, times);
    } else {
        move_geometry(samples, times);
    }
}

// --- resources (ri.md 6.12): saved attributes by name ---

void State::do_Resource(Request& request) {
    const std::string& name = request.string(0);
    if (request.string(1) != "attributes") {
        warn_once("resource:" + request.string(1), base::Code::Unimplement, request,
                  "type " + quoted(request.string(1)) + " is not known; ignored");
        return;
    }
    const std::string operation = request.params.get_string("operation", "");
    if (operation == "save") {
        resources_[name] = attributes_;
        resources_[name].id = none;
    } else if (operation == "restore" && resources_.contains(name)) {
        const Attributes& from = resources_[name].value;
        const std::string subset = request.params.get_string("subset", "all");
        Attributes& to = edit_attributes();
        if (subset == "all") {
            to = from;
        } else if (subset == "shading") {
            to.color = from.color;
            to.opacity = from.opacity;
            to.surface = from.surface;
            to.displacement = from.displacement;
            to.atmosphere = from.atmosphere;
            to.interior = from.interior;
            to.exterior = from.exterior;
            to.lights = from.lights;
        } else {
            warn(base::Code::Unimplement, request, "subset " + quoted(subset) + " is ignored");
        }
    } else {
        error(base::Code::BadHandle, request,
              operation == "restore" ? "nothing was saved as " + quoted(name) + "; ignored"
                                     : "operation " + quoted(operation) + " is not known; ignored");
    }
}

// --- requests about the stream ---

void State::do_ReadArchive(Request& request) {
    if (world_wanted_) { // what a picture nobody asked for consists of need not be found
        host_.read_archive(request.string(0), request.pos);
    }
}

void State::do_ArchiveBegin(Request& request) {
    host_.begin_archive(request.string(0), request.pos);
}

void State::do_ArchiveEnd(Request& request) {
    error(base::Code::Nesting, request, "no ArchiveBegin is open; ignored");
}

void State::do_IfBegin(Request& request) {
    host_.conditional(request);
}

void State::do_ElseIf(Request& request) {
    host_.conditional(request);
}

void State::do_Else(Request& request) {
    host_.conditional(request);
}

void State::do_IfEnd(Request& request) {
    host_.conditional(request);
}

} // namespace rib
