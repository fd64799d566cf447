// SPDX-License-Identifier: Apache-2.0
// State: retained objects and their instances (ri.md 12.2).
//
// Geometry is kept once, in the space of the definition. What an object itself sets (its edits) is
// kept as requests and replayed on the attributes in force at each instance, so the result is what
// replaying the whole object would give.
#include "ribtools/state_impl.h"

namespace rib {

namespace {

// Objects in objects: instances multiply with every level.
constexpr int max_object_depth = 64;
constexpr std::size_t max_expansion = 1u << 22;

} // namespace

// Where and with what an object is drawn.
struct State::InstanceSite {
    Transform place; // world (or enclosing definition) from definition
    Attributes attributes;
    std::uint32_t solid = none;
};

void State::do_ObjectBegin(Request& request) {
    open(BlockKind::Object, request);
    Object object;
    object.handle = request.string(0);
    object_handles_[object.handle] = static_cast<std::uint32_t>(scene_->objects.size());
    scene_->objects.push_back(std::move(object));
    objects_.push_back(std::make_shared<ObjectRecord>());
    open_object_ = objects_.back().get();
    object_base_ = transform_.value.still();
    current_edit_ = none;
    current_solid_ = none;
    transform_ = {Transform(), none};
    if (attributes_.value.area_light != none) {
        edit_attributes().area_light = none; // instances decide
    }
}

void State::finish_object() {
    scene_->objects[objects_.size() - 1].primitives = std::move(open_object_->primitives);
    open_object_->primitives.clear();
    open_object_ = nullptr;
}

void State::do_ObjectEnd(Request& request) {
    if (close(BlockKind::Object, request)) {
        finish_object();
        restore(BlockKind::Object);
    }
}

// The attributes that the chain of edits ending at `edit` makes of `start`. The state's own are
// borrowed meanwhile.
std::uint32_t State::replay(const ObjectRecord& record, std::uint32_t edit, const Attributes& start,
                            const Transform& place) {
    std::vector<std::uint32_t> chain;
    for (std::uint32_t at = edit; at != none; at = record.edits[at].parent) {
        chain.push_back(at);
    }
    const Frozen<Attributes> attributes = std::move(attributes_);
    const Frozen<Transform> transform = std::move(transform_);
    ObjectRecord* const open_object = open_object_;
    open_object_ = nullptr;
    replaying_ = true;
    attributes_ = {start, none};
    for (auto it = chain.rbegin(); it != chain.rend(); ++it) {
        Request request = record.edits[*it].request;
        transform_ = {place * record.edits[*it].definition_from_current, none};
        dispatch(request);
    }
    const std::uint32_t id = freeze_attributes();
    replaying_ = false;
    open_object_ = open_object;
    attributes_ = attributes;
    transform_ = transform;
    return id;
}

// Adds the instance, and those of the objects drawn inside the object.
void State::instantiate(std::uint32_t object, const InstanceSite& site, const Request& request,
                        int depth, std::size_t& budget) {
    if (depth > max_object_depth || budget == 0) {
        diag_.report_once(
            "object-expansion", base::Severity::Error, base::Code::Limit, request.pos,
            "ObjectInstance: objects in objects expand to too many instances; the rest "
            "is left out");
        return;
    }
    --budget;
    const std::shared_ptr<ObjectRecord> record = objects_[object];
    if (!record->group_of_primitive.empty()) {
        std::vector<std::uint32_t> ids;
        for (const ObjectRecord::Group& group : record->groups) {
            Attributes start = site.attributes;
            start.basis = group.basis;
            start.trim = group.trim;
            ids.push_back(replay(*record, group.edit, start, site.place));
        }
        Instance instance;
        instance.object = object;
        instance.world_from_object = add_transform(site.place);
        for (const std::uint32_t group : record->group_of_primitive) {
            instance.attributes.push_back(ids[group]);
        }
        instance.solid = site.solid;
        instance.pos = request.pos;
        if (site.attributes.area_light == none) {
            scene_->instances.push_back(std::move(instance));
        } else {
            become_primitives(instance, site);
        }
    }
    for (const ObjectRecord::Child& child : record->children) {
        const std::uint32_t id = replay(*record, child.edit, site.attributes, site.place);
        const InstanceSite inner{site.place * child.definition_from_child, scene_->attributes[id],
                                 site.solid == none ? child.solid : site.solid};
        instantiate(child.object, inner, request, depth + 1, budget);
    }
}

// Geometry of an area light is listed primitive by primitive, so its instances are written out.
void State::become_primitives(const Instance& instance, const InstanceSite& site) {
    const Shared<std::vector<Primitive>> members = scene_->objects[instance.object].primitives;
    for (std::size_t i = 0; i < members.size(); ++i) {
        Primitive copy = members[i];
        copy.attributes = instance.attributes[i];
        copy.world_from_object =
            add_transform(site.place * scene_->transforms[members[i].world_from_object]);
        copy.solid = site.solid == none ? copy.solid : site.solid;
        scene_->lights[site.attributes.area_light].area_primitives.push_back(
            static_cast<std::uint32_t>(scene_->primitives.size()));
        scene_->primitives.push_back(std::move(copy));
    }
}

void State::do_ObjectInstance(Request& request) {
    const std::string& handle = request.string(0);
    const auto it = object_handles_.find(handle);
    const bool is_open =
        open_object_ && it != object_handles_.end() && it->second == objects_.size() - 1;
    if (it == object_handles_.end() || is_open) {
        error(base::Code::BadHandle, request,
              is_open ? "object " + quoted(handle) + " would hold itself; skipped"
                      : "no object has the handle " + quoted(handle) + "; skipped");
        return;
    }
    if (open_object_) {
        open_object_->children.push_back(
            {it->second, current_edit_, transform_.value, current_solid_});
        return;
    }
    if (!world_wanted_) {
        return;
    }
    std::size_t budget = max_expansion;
    instantiate(it->second, {transform_.value, attributes_.value, solid_for_geometry()}, request, 0,
                budget);
}

} // namespace rib
