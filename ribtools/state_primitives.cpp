// SPDX-License-Identifier: Apache-2.0
// State: primitives and solids (ri.md 6.9, 6.10, 12.1). Requests become shapes here; check.cpp
// judges them.
#include "ribtools/check.h"
#include "ribtools/number.h"
#include "ribtools/state_impl.h"

#include <algorithm>
#include <numeric>

namespace rib {

// --- storing ---

void State::emit(Shape shape, Request& request) {
    Primitive primitive;
    primitive.shape = std::move(shape);
    primitive.params = std::move(request.params);
    primitive.pos = request.pos;
    if (!check_primitive(primitive, attributes_.value.basis, row(request.id).name, diag_)) {
        return;
    }
    if (motion_sink_) {
        motion_sink_->push_back(std::move(primitive));
    } else {
        store(std::move(primitive));
    }
}

void State::store(Primitive primitive) {
    if (!world_wanted_ && !open_object_) {
        return;
    }
    primitive.attributes = freeze_attributes();
    primitive.world_from_object = freeze_transform();
    primitive.solid = solid_for_geometry();
    if (open_object_) {
        ObjectRecord& record = *open_object_;
        const Attributes& a = attributes_.value;
        const bool same_group = !record.groups.empty() &&
                                record.groups.back().edit == current_edit_ &&
                                record.groups.back().basis.same_object(a.basis) &&
                                record.groups.back().trim.same_object(a.trim);
        if (!same_group) {
            record.groups.push_back({current_edit_, a.basis, a.trim});
        }
        record.group_of_primitive.push_back(static_cast<std::uint32_t>(record.groups.size() - 1));
        record.primitives.push_back(std::move(primitive));
        return;
    }
    if (attributes_.value.area_light != none) {
        scene_->lights[attributes_.value.area_light].area_primitives.push_back(
            static_cast<std::uint32_t>(scene_->primitives.size()));
    }
    scene_->primitives.push_back(std::move(primitive));
}

// Samples of moving geometry: same topology, the values differ.
void State::move_geometry(std::span<Request> samples, std::span<const float> times) {
    const Request first = samples[0];
    std::vector<Primitive> keys;
    motion_sink_ = &keys;
    for (Request& sample : samples) {
        dispatch(sample);
    }
    motion_sink_ = nullptr;
    if (keys.empty()) {
        return; // reported
    }
    Primitive primitive = std::move(keys[0]);
    bool good = keys.size() == samples.size();
    for (std::size_t i = 1; good && i < keys.size(); ++i) {
        good = same_topology(primitive, keys[i]);
    }
    if (!good) {
        error(base::Code::BadMotion, first,
              "the samples of the motion block differ in more than values; the first is used");
    }
    for (std::size_t i = 0; good && i < keys.size(); ++i) {
        // Key 0 is the primitive itself; its entry holds the time only.
        Primitive::MotionKey key;
        key.time = times[i];
        if (i > 0) {
            key.shape = std::move(keys[i].shape);
            key.params = std::move(keys[i].params);
        }
        primitive.motion.push_back(std::move(key));
    }
    store(std::move(primitive));
}

// --- quadrics ---

void State::quadric(Request& request, QuadricKind kind, int num_args) {
    Quadric q;
    q.kind = kind;
    for (int i = 0; i < num_args; ++i) {
        q.args[static_cast<std::size_t>(i)] = request.number(i);
    }
    emit(q, request);
}

void State::do_Sphere(Request& request) {
    quadric(request, QuadricKind::Sphere, 4);
}
void State::do_Cone(Request& request) {
    quadric(request, QuadricKind::Cone, 3);
}
void State::do_Cylinder(Request& request) {
    quadric(request, QuadricKind::Cylinder, 4);
}
void State::do_Hyperboloid(Request& request) {
    quadric(request, QuadricKind::Hyperboloid, 7);
}
void State::do_Paraboloid(Request& request) {
    quadric(request, QuadricKind::Paraboloid, 4);
}
void State::do_Disk(Request& request) {
    quadric(request, QuadricKind::Disk, 3);
}
void State::do_Torus(Request& request) {
    quadric(request, QuadricKind::Torus, 5);
}

// --- polygons: all in the form of PointsGeneralPolygons ---

namespace {

std::vector<std::int32_t> counting(std::size_t n) {
    std::vector<std::int32_t> indices(n);
    std::iota(indices.begin(), indices.end(), 0);
    return indices;
}

// Number of positions a primitive's parameters give, whichever variable they are in.
std::size_t num_positions(const ParamList& params) {
    for (const char* name : {"P", "Pw", "Pz"}) {
        if (const Param* p = params.find(name)) {
            return p->num_items();
        }
    }
    return 0;
}

} // namespace

void State::polygons(Request& request, std::vector<std::int32_t> num_loops,
                     std::vector<std::int32_t> num_vertices, std::vector<std::int32_t> vertices) {
    emit(Polygons{std::move(num_loops), std::move(num_vertices), std::move(vertices)}, request);
}

void State::do_Polygon(Request& request) {
    const std::size_t n = num_positions(request.params);
    polygons(request, {1}, {static_cast<std::int32_t>(n)}, counting(n));
}

void State::do_GeneralPolygon(Request& request) {
    const std::vector<std::int32_t>& loops = request.args[0].ints;
    const std::size_t n = num_positions(request.params);
    const auto num_loops = static_cast<std::int32_t>(loops.size());
    std::int64_t wanted = 0;
    for (const std::int32_t count : loops) {
        wanted += std::max(count, 0);
    }
    // Loops that ask for more vertices than there are get no huge index list: check_primitive
    // counts again.
    const std::size_t have =
        static_cast<std::size_t>(std::min<std::int64_t>(wanted, static_cast<std::int64_t>(n)));
    polygons(request, {num_loops}, loops, counting(have));
}

void State::do_PointsPolygons(Request& request) {
    const std::size_t num_polygons = request.args[0].ints.size();
    polygons(request, std::vector<std::int32_t>(num_polygons, 1), std::move(request.args[0].ints),
             std::move(request.args[1].ints));
}

void State::do_PointsGeneralPolygons(Request& request) {
    polygons(request, std::move(request.args[0].ints), std::move(request.args[1].ints),
             std::move(request.args[2].ints));
}

// --- patches ---

namespace {

// Sets *flag if text is the first word, clears it if one of the others; false if neither.
bool choose(const std::string& text, std::string_view yes,
            std::initializer_list<std::string_view> no, bool& flag) {
    flag = text == yes;
    return flag || std::find(no.begin(), no.end(), text) != no.end();
}

} // namespace

void State::do_Patch(Request& request) {
    Patches p;
    if (!choose(request.string(0), "bicubic", {"bilinear"}, p.bicubic)) {
        error(base::Code::BadToken, request,
              "unknown type " + quoted(request.string(0)) + "; skipped");
        return;
    }
    p.nu = p.nv = p.bicubic ? 4 : 2;
    emit(p, request);
}

void State::do_PatchMesh(Request& request) {
    Patches p;
    const std::initializer_list<std::string_view> open = {"nonperiodic", "nowrap"};
    if (!choose(request.string(0), "bicubic", {"bilinear"}, p.bicubic) ||
        !choose(request.string(2), "periodic", open, p.uperiodic) ||
        !choose(request.string(4), "periodic", open, p.vperiodic)) {
        error(base::Code::BadToken, request, "unknown type or wrap mode; skipped");
        return;
    }
    p.is_mesh = true;
    p.nu = request.integer(1);
    p.nv = request.integer(3);
    emit(p, request);
}

void State::do_NuPatch(Request& request) {
    NuPatch p;
    p.nu = request.integer(0);
    p.uorder = request.integer(1);
    p.uknot = std::move(request.args[2].floats);
    p.umin = request.real(3);
    p.umax = request.real(4);
    p.nv = request.integer(5);
    p.vorder = request.integer(6);
    p.vknot = std::move(request.args[7].floats);
    p.vmin = request.real(8);
    p.vmax = request.real(9);
    emit(std::move(p), request);
}

void State::subdivision_mesh(Request& request, bool hierarchical) {
    SubdivisionMesh m;
    m.scheme = request.string(0);
    m.num_vertices = std::move(request.args[1].ints);
    m.vertices = std::move(request.args[2].ints);
    m.tags = std::move(request.args[3].strings);
    m.num_args = std::move(request.args[4].ints);
    m.int_args = std::move(request.args[5].ints);
    m.float_args = std::move(request.args[6].floats);
    m.string_args = std::move(request.args[7].strings);
    m.hierarchical = hierarchical;
    emit(std::move(m), request);
}

void State::do_SubdivisionMesh(Request& request) {
    subdivision_mesh(request, false);
}
void State::do_HierarchicalSubdivisionMesh(Request& request) {
    subdivision_mesh(request, true);
}

// --- points, curves, blobs ---

void State::do_Points(Request& request) {
    emit(Points{num_positions(request.params)}, request);
}

void State::do_Curves(Request& request) {
    Curves c;
    if (!choose(request.string(0), "cubic", {"linear"}, c.cubic) ||
        !choose(request.string(2), "periodic", {"nonperiodic", "nowrap"}, c.periodic)) {
        error(base::Code::BadToken, request, "unknown type or wrap mode; skipped");
        return;
    }
    c.num_vertices = std::move(request.args[1].ints);
    emit(std::move(c), request);
}

void State::do_Blobby(Request& request) {
    Blobby b;
    b.num_leaves = request.integer(0);
    b.code = std::move(request.args[1].ints);
    b.floats = std::move(request.args[2].floats);
    b.strings = std::move(request.args[3].strings);
    emit(std::move(b), request);
}

// --- procedurals and other shapes ---

// An archive is expanded here: its RIB must be read in order anyway, since it may declare names.
// The two kinds that run foreign code are kept for a renderer that may (ri.md 11.14).
void State::do_Procedural(Request& request) {
    const std::string kind = request.string(0) == "ReadProgram" ? "RunProgram" : request.string(0);
    Procedural p;
    p.kind = kind;
    p.args = std::move(request.args[1].strings);
    std::transform(request.args[2].numbers.begin(), request.args[2].numbers.end(), p.bound.begin(),
                   narrow);
    if (kind == "DelayedReadArchive" && !p.args.empty()) {
        Request begin;
        begin.id = RequestId::AttributeBegin;
        begin.pos = request.pos;
        const std::size_t depth = blocks_.depth();
        open(BlockKind::Attribute, begin);
        host_.read_archive(p.args[0], request.pos);
        close_blocks(request.pos, depth + 1, true);
        if (blocks_.depth() > depth) {
            restore(BlockKind::Attribute);
        }
    } else if (kind == "RunProgram" || kind == "DynamicLoad") {
        warn_once("procedural:" + kind, base::Code::Incapable, request,
                  kind + ": programs and libraries are not run from a RIB; nothing is drawn");
        emit(std::move(p), request);
    } else {
        error(base::Code::BadToken, request, "unknown procedural " + quoted(kind) + "; skipped");
    }
}

void State::do_Procedural2(Request& request) {
    Procedural p;
    p.kind = request.string(0);
    p.args = {request.string(1)};
    warn_once("procedural:" + p.kind, base::Code::Unimplement, request,
              "outside RI 3.2; nothing is drawn");
    emit(std::move(p), request);
}

void State::do_Geometry(Request& request) {
    emit(Geometry{request.string(0), {}, {}}, request);
}

void State::do_Volume(Request& request) {
    Geometry g{request.string(0), {}, std::move(request.args[2].ints)};
    for (const double x : request.args[1].numbers) {
        g.floats.push_back(narrow(x));
    }
    emit(std::move(g), request);
}

// --- solids ---

void State::do_SolidBegin(Request& request) {
    static constexpr std::pair<std::string_view, SolidOp> ops[] = {
        {"primitive", SolidOp::Primitive},
        {"union", SolidOp::Union},
        {"intersection", SolidOp::Intersection},
        {"difference", SolidOp::Difference}};
    const auto* op = std::find_if(std::begin(ops), std::end(ops),
                                  [&](const auto& o) { return o.first == request.string(0); });
    SolidOp kind = SolidOp::Primitive;
    if (op == std::end(ops)) {
        error(base::Code::BadToken, request,
              "unknown operation " + quoted(request.string(0)) + "; taken as primitive");
    } else {
        kind = op->second;
    }
    open(BlockKind::Solid, request);
    const bool inside_primitive =
        current_solid_ != none && scene_->solids[current_solid_].op == SolidOp::Primitive;
    if (inside_primitive) {
        error(base::Code::BadSolid, request,
              "a primitive solid holds no other solids; its surfaces join the outer one");
        return;
    }
    ++solid_operands_[current_solid_];
    scene_->solids.push_back({kind, current_solid_});
    current_solid_ = static_cast<std::uint32_t>(scene_->solids.size() - 1);
}

void State::do_SolidEnd(Request& request) {
    if (!close(BlockKind::Solid, request)) {
        return;
    }
    const std::uint32_t node = current_solid_;
    restore(BlockKind::Solid);
    if (node == current_solid_ || node == none || scene_->solids[node].op != SolidOp::Difference) {
        return;
    }
    if (solid_operands_[node] < 2) {
        warn(base::Code::BadSolid, request, "a difference of fewer than two solids");
    }
}

// Geometry directly in a composite block is a primitive solid of its own (ri.md 12.1).
std::uint32_t State::solid_for_geometry() {
    if (current_solid_ == none || scene_->solids[current_solid_].op == SolidOp::Primitive) {
        return current_solid_;
    }
    ++solid_operands_[current_solid_];
    scene_->solids.push_back({SolidOp::Primitive, current_solid_});
    return static_cast<std::uint32_t>(scene_->solids.size() - 1);
}

} // namespace rib
