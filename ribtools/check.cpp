// SPDX-License-Identifier: Apache-2.0
#include "ribtools/check.h"

#include "ribtools/declare.h"
#include "ribtools/spelling.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <type_traits>

namespace rib {

namespace {

// What one check needs to speak.
struct Judge {
    base::Diag& diag;
    std::string_view name;
    base::SourcePos pos;

    bool reject(base::Code code, const std::string& text) const {
        report(base::Severity::Error, code, pos, text + "; skipped", base::max_alike);
        return false;
    }
    void warn(base::Code code, base::SourcePos at, const std::string& text,
              std::uint64_t most = base::max_alike) const {
        report(base::Severity::Warning, code, at, text, most);
    }
    void report(base::Severity severity, base::Code code, base::SourcePos at,
                const std::string& text, std::uint64_t most) const {
        const std::string whole = std::string(name) + ": " + text;
        diag.report_few(base::kind_of(whole), most, severity, code, at, whole);
    }
};

std::string num(std::size_t n) {
    return std::to_string(n);
}

std::string num_text(float x) {
    char buffer[32];
    return {buffer, std::to_chars(buffer, std::end(buffer), x).ptr};
}

// Sum of counts; nullopt if one is negative.
std::optional<std::size_t> sum_of(const std::vector<std::int32_t>& counts) {
    std::size_t sum = 0;
    for (const std::int32_t n : counts) {
        if (n < 0) {
            return std::nullopt;
        }
        sum += static_cast<std::size_t>(n);
    }
    return sum;
}

// One more than the largest index; nullopt if one is negative.
std::optional<std::size_t> num_indexed(const std::vector<std::int32_t>& indices) {
    std::int32_t largest = -1;
    for (const std::int32_t i : indices) {
        if (i < 0) {
            return std::nullopt;
        }
        largest = std::max(largest, i);
    }
    return static_cast<std::size_t>(largest) + 1;
}

// Segments along one direction of a bicubic mesh or curve of n points, ri.md 10.3. 0: too few.
std::size_t num_segments(std::size_t n, std::size_t step, bool periodic) {
    return periodic ? n / step : n < 4 ? 0 : (n - 4) / step + 1;
}

std::size_t patches_along(const Patches& p, bool along_u, const Basis& basis) {
    const auto n = static_cast<std::size_t>(std::max(along_u ? p.nu : p.nv, 0));
    const bool periodic = along_u ? p.uperiodic : p.vperiodic;
    if (!p.bicubic) {
        return periodic ? n : n < 1 ? 0 : n - 1;
    }
    return num_segments(n, static_cast<std::size_t>(along_u ? basis.ustep : basis.vstep), periodic);
}

ClassCounts patch_counts(const Patches& p, const Basis& basis) {
    if (!p.is_mesh) {
        return {1, 4, p.bicubic ? 16u : 4u, 4};
    }
    const std::size_t nup = patches_along(p, true, basis), nvp = patches_along(p, false, basis);
    return {nup * nvp, (nup + !p.uperiodic) * (nvp + !p.vperiodic),
            static_cast<std::size_t>(p.nu) * static_cast<std::size_t>(p.nv), 4 * nup * nvp};
}

ClassCounts nu_patch_counts(const NuPatch& p) {
    const auto segments_u = static_cast<std::size_t>(1 + p.nu - p.uorder);
    const auto segments_v = static_cast<std::size_t>(1 + p.nv - p.vorder);
    return {segments_u * segments_v, (segments_u + 1) * (segments_v + 1),
            static_cast<std::size_t>(p.nu) * static_cast<std::size_t>(p.nv),
            4 * segments_u * segments_v};
}

ClassCounts curve_counts(const Curves& c, const Basis& basis) {
    ClassCounts counts{c.num_vertices.size(), 0, 0, 0};
    for (const std::int32_t signed_n : c.num_vertices) {
        const auto n = static_cast<std::size_t>(signed_n);
        const std::size_t segments =
            c.cubic ? num_segments(n, static_cast<std::size_t>(basis.vstep), c.periodic)
                    : (c.periodic ? n : n - 1);
        counts.varying += segments + !c.periodic;
        counts.vertex += n;
    }
    counts.face_varying = counts.varying;
    return counts;
}

// --- one judgement per shape: false = rejected, reported ---

bool judge(Quadric& q, const Judge& to, const Basis&) {
    const auto& a = q.args;
    if (!std::all_of(a.begin(), a.end(), [](double x) { return std::isfinite(x); })) {
        return to.reject(base::Code::Range, "a value is not finite");
    }
    const auto empty = [&](bool is_empty, const char* text) {
        return is_empty ? to.reject(base::Code::Range, text) : true;
    };
    switch (q.kind) {
    case QuadricKind::Sphere: {
        const double r = std::fabs(a[0]);
        return empty(r == 0 || a[3] == 0 || a[1] == a[2], "radius, height or sweep is zero") &&
               empty(std::min(a[1], a[2]) >= r || std::max(a[1], a[2]) <= -r,
                     "zmin and zmax leave nothing of the sphere");
    }
    case QuadricKind::Cone:
        return empty(a[1] == 0 || a[2] == 0, "radius or sweep is zero");
    case QuadricKind::Cylinder:
        return empty(a[0] == 0 || a[1] == a[2] || a[3] == 0, "radius, height or sweep is zero");
    case QuadricKind::Hyperboloid:
        return empty(a[6] == 0 || (a[0] == a[3] && a[1] == a[4] && a[2] == a[5]),
                     "the two points coincide or the sweep is zero");
    case QuadricKind::Paraboloid:
        return empty(a[0] == 0 || a[1] == a[2] || a[3] == 0, "radius, height or sweep is zero") &&
               empty(a[2] == 0 || a[1] / a[2] < 0, "zmin and zmax must lie on one side of the tip");
    case QuadricKind::Disk:
        return empty(a[1] == 0 || a[2] == 0, "radius or sweep is zero");
    case QuadricKind::Torus:
        return empty(a[1] == 0 || a[2] == a[3] || a[4] == 0, "minor radius or sweep is zero");
    }
    return true;
}

bool judge(Polygons& p, const Judge& to, const Basis&) {
    const std::optional<std::size_t> loops = sum_of(p.num_loops);
    const std::optional<std::size_t> corners = sum_of(p.num_vertices);
    if (!loops || !corners) {
        return to.reject(base::Code::Range, "a count is negative");
    }
    if (*loops != p.num_vertices.size()) {
        return to.reject(base::Code::Consistency, num(p.num_vertices.size()) + " loops where " +
                                                      num(*loops) + " were announced");
    }
    if (*corners > p.vertices.size()) {
        return to.reject(base::Code::Consistency, num(p.vertices.size()) + " vertices where " +
                                                      num(*corners) + " were announced");
    }
    if (*corners < p.vertices.size()) {
        to.warn(base::Code::Consistency, to.pos,
                num(p.vertices.size()) + " vertices where " + num(*corners) +
                    " were announced; the surplus is ignored");
        p.vertices.resize(*corners);
    }
    if (!num_indexed(p.vertices)) {
        return to.reject(base::Code::Range, "a vertex index is negative");
    }
    if (*corners < 3) {
        return to.reject(base::Code::Range, "fewer than three vertices");
    }
    return true;
}

bool judge(Patches& p, const Judge& to, const Basis& basis) {
    if (p.nu < 2 || p.nv < 2 || patches_along(p, true, basis) == 0 ||
        patches_along(p, false, basis) == 0) {
        return to.reject(base::Code::Range,
                         "too few control points for one patch: " + std::to_string(p.nu) + " by " +
                             std::to_string(p.nv));
    }
    if (!p.bicubic || !p.is_mesh) {
        return true;
    }
    const auto left_over = [&](int n, int step, bool periodic) {
        return (periodic ? n : n - 4) % step != 0;
    };
    if (left_over(p.nu, basis.ustep, p.uperiodic) || left_over(p.nv, basis.vstep, p.vperiodic)) {
        to.warn(
            base::Code::Consistency, to.pos,
            "the number of control points does not fit the basis steps; the last ones are unused");
    }
    return true;
}

bool judge_knots(const std::vector<float>& knots, std::size_t wanted, const Judge& to) {
    if (knots.size() < wanted) {
        return to.reject(base::Code::Consistency,
                         num(knots.size()) + " knots where " + num(wanted) + " are needed");
    }
    if (!std::is_sorted(knots.begin(), knots.begin() + static_cast<std::ptrdiff_t>(wanted))) {
        return to.reject(base::Code::Range, "the knots decrease");
    }
    return true;
}

// One direction of a NURBS surface, ri.md 11.6.
bool judge_direction(char axis, int n, int& order, std::vector<float>& knots, float& low,
                     float& high, const Judge& to) {
    if (n < 1 || order < 1) {
        return to.reject(base::Code::Range, "number of points and order must be positive");
    }
    if (order > n) {
        to.warn(base::Code::Consistency, to.pos, "the order exceeds the number of points; lowered");
        order = n;
    }
    const auto wanted = static_cast<std::size_t>(n) + static_cast<std::size_t>(order);
    if (!judge_knots(knots, wanted, to)) {
        return false;
    }
    knots.resize(wanted);
    const float first = knots[static_cast<std::size_t>(order) - 1];
    const float last = knots[static_cast<std::size_t>(n)];
    if (low < first || high > last) {
        to.warn(base::Code::Range, to.pos,
                std::string("the ") + axis + " range " + num_text(low) + " to " + num_text(high) +
                    " exceeds that of the knots, " + num_text(first) + " to " + num_text(last) +
                    "; clamped",
                1); // programs that do so do it in every patch
        low = std::max(low, first);
        high = std::min(high, last);
    }
    return low < high ? true : to.reject(base::Code::Range, "the parameter range is empty");
}

bool judge(NuPatch& p, const Judge& to, const Basis&) {
    return judge_direction('u', p.nu, p.uorder, p.uknot, p.umin, p.umax, to) &&
           judge_direction('v', p.nv, p.vorder, p.vknot, p.vmin, p.vmax, to);
}

bool judge(SubdivisionMesh& m, const Judge& to, const Basis&) {
    if (m.scheme != "catmull-clark" && m.scheme != "loop" && m.scheme != "bilinear") {
        return to.reject(base::Code::BadToken, "unknown scheme '" + printable(m.scheme) + "'");
    }
    const std::optional<std::size_t> corners = sum_of(m.num_vertices);
    if (!corners || !num_indexed(m.vertices)) {
        return to.reject(base::Code::Range, "a count or vertex index is negative");
    }
    if (*corners != m.vertices.size() || m.num_vertices.empty()) {
        return to.reject(base::Code::Consistency, num(m.vertices.size()) + " vertices where " +
                                                      num(*corners) + " were announced");
    }
    const std::size_t per_tag = m.hierarchical ? 3 : 2;
    bool tags_fit = m.num_args.size() >= m.tags.size() * per_tag;
    std::size_t sums[3] = {};
    for (std::size_t i = 0; tags_fit && i < m.tags.size() * per_tag; ++i) {
        tags_fit = m.num_args[i] >= 0;
        sums[i % per_tag] += static_cast<std::size_t>(std::max(m.num_args[i], 0));
    }
    tags_fit = tags_fit && sums[0] <= m.int_args.size() && sums[1] <= m.float_args.size() &&
               sums[2] <= m.string_args.size();
    if (!tags_fit) {
        to.warn(base::Code::Consistency, to.pos,
                "tag arguments do not match their counts; tags dropped");
        m.tags.clear();
        m.num_args.clear();
    }
    return true;
}

bool judge(Points& p, const Judge& to, const Basis&) {
    return p.count > 0 ? true : to.reject(base::Code::MissingData, "no \"P\"");
}

bool judge(Curves& c, const Judge& to, const Basis& basis) {
    const std::int32_t least = c.cubic ? (c.periodic ? std::max(3, basis.vstep) : 4) : 2;
    if (c.num_vertices.empty()) {
        return to.reject(base::Code::Range, "no curves");
    }
    for (const std::int32_t n : c.num_vertices) {
        if (n < least) {
            return to.reject(base::Code::Range, "a curve of " + std::to_string(n) +
                                                    " vertices; at least " + std::to_string(least) +
                                                    " are needed");
        }
    }
    return true;
}

// Walks the instructions of ri.md 11.12; the count of leaves is ours, not the file's.
bool judge(Blobby& b, const Judge& to, const Basis&) {
    const auto has = [](std::int64_t at, std::size_t count, std::size_t size) {
        return at >= 0 && static_cast<std::size_t>(at) + count <= size;
    };
    int leaves = 0;
    std::int32_t result = 0;
    for (std::size_t k = 0; k < b.code.size(); ++result) {
        const std::int32_t op = b.code[k++];
        std::size_t operands = op >= 0 && op <= 3 && k < b.code.size()
                                   ? static_cast<std::size_t>(std::max(b.code[k++], 0))
                               : op == 4 || op == 5 || op == 1003 ? 2
                               : op == 8                          ? 0
                               : op == 1004                       ? 5
                                                                  : 1;
        if (op == 9000 && k < b.code.size()) {
            operands = static_cast<std::size_t>(std::max(b.code[k++], 0));
        } else if (op < 0 || (op > 8 && (op < 1000 || op > 1004))) {
            return to.reject(base::Code::Range, "unknown instruction " + std::to_string(op));
        }
        if (operands > b.code.size() - k) {
            return to.reject(base::Code::Consistency, "the code ends inside an instruction");
        }
        const std::int32_t* arg = b.code.data() + k;
        k += operands;
        bool good = true;
        if (op >= 1000) {
            ++leaves;
            const std::size_t floats = op == 1000 ? 1 : op == 1001 ? 16 : op == 1002 ? 23 : 4;
            good = op == 1003 ? has(arg[0], 1, b.strings.size()) && has(arg[1], 4, b.floats.size())
                   : op == 1004 ? has(arg[0], 1, b.strings.size())
                                : has(arg[0], floats, b.floats.size());
        } else {
            good = std::all_of(arg, arg + operands,
                               [&](std::int32_t i) { return i >= 0 && i < result; });
        }
        if (!good) {
            return to.reject(base::Code::Range, "instruction " + std::to_string(result) +
                                                    " refers to what does not exist");
        }
    }
    if (result == 0) {
        return to.reject(base::Code::Range, "no instructions");
    }
    if (leaves != b.num_leaves) {
        to.warn(base::Code::Consistency, to.pos,
                "the code has " + std::to_string(leaves) + " leaves, not " +
                    std::to_string(b.num_leaves));
        b.num_leaves = leaves;
    }
    return true;
}

bool judge(Geometry&, const Judge&, const Basis&) {
    return true;
}

bool judge(Procedural&, const Judge&, const Basis&) {
    return true;
}

// --- parameters ---

bool is_position(const Param& p) {
    return p.name == "P" || p.name == "Pw" || p.name == "Pz";
}

bool needs_position(const Shape& shape) {
    return !std::holds_alternative<Quadric>(shape) && !std::holds_alternative<Blobby>(shape) &&
           !std::holds_alternative<Geometry>(shape) && !std::holds_alternative<Procedural>(shape);
}

bool has_free_counts(const Shape& shape) {
    return std::holds_alternative<Geometry>(shape) || std::holds_alternative<Procedural>(shape);
}

// Vertices nobody refers to are common in shared meshes and no mistake.
bool may_have_unused_vertices(const Shape& shape) {
    return std::holds_alternative<Polygons>(shape) ||
           std::holds_alternative<SubdivisionMesh>(shape);
}

void keep_items(Param& p, std::size_t items) {
    const std::size_t per_item = static_cast<std::size_t>(p.decl.array_length);
    const std::size_t numbers = per_item * static_cast<std::size_t>(components(p.decl.type));
    p.floats.resize(std::min(p.floats.size(), items * numbers));
    p.ints.resize(std::min(p.ints.size(), items * per_item));
    p.strings.resize(std::min(p.strings.size(), items * per_item));
}

bool good_position_type(const Param& p) {
    const ParamType want = p.name == "Pw"   ? ParamType::HPoint
                           : p.name == "Pz" ? ParamType::Float
                                            : ParamType::Point;
    return p.decl.type == want && p.decl.array_length == 1;
}

enum class Verdict : std::uint8_t { Keep, Drop, Reject };

Verdict judge_param(Param& p, const ClassCounts& counts, bool unused_vertices, const Judge& to) {
    const std::size_t wanted = counts.of(p.decl.storage);
    const std::size_t have = p.num_items();
    const bool position = is_position(p);
    const std::string what = "parameter '" + printable(p.name) + "' (" + declaration_text(p.decl) +
                             "): " + num(have) + " values where " + num(wanted) + " are expected";
    if (position && !good_position_type(p)) {
        to.reject(base::Code::BadToken,
                  "\"" + p.name + "\" has the wrong type (" + declaration_text(p.decl) + ")");
        return Verdict::Reject;
    }
    if (have < wanted) {
        to.report(base::Severity::Error, base::Code::Consistency, p.pos,
                  what + (position ? "; skipped" : "; parameter dropped"), base::max_alike);
        return position ? Verdict::Reject : Verdict::Drop;
    }
    const bool per_vertex = wanted == counts.vertex && unused_vertices;
    if (have > wanted && !per_vertex) {
        to.warn(base::Code::Consistency, p.pos, what + "; the surplus is ignored");
        keep_items(p, wanted);
    }
    return Verdict::Keep;
}

bool judge_params(Primitive& primitive, const Basis& basis, const Judge& to) {
    std::vector<Param>& params = primitive.params.params;
    if (needs_position(primitive.shape) &&
        std::none_of(params.begin(), params.end(), is_position)) {
        return to.reject(base::Code::MissingData, "no \"P\"");
    }
    if (has_free_counts(primitive.shape)) {
        return true;
    }
    const ClassCounts counts = class_counts(primitive.shape, basis);
    const bool unused_vertices = may_have_unused_vertices(primitive.shape);
    bool good = true;
    std::erase_if(params, [&](Param& p) {
        const Verdict verdict = judge_param(p, counts, unused_vertices, to);
        good &= verdict != Verdict::Reject;
        return verdict != Verdict::Keep;
    });
    return good;
}

} // namespace

std::size_t ClassCounts::of(StorageClass storage) const {
    switch (storage) {
    case StorageClass::Constant:
        return 1;
    case StorageClass::Uniform:
        return uniform;
    case StorageClass::Varying:
        return varying;
    case StorageClass::Vertex:
        return vertex;
    case StorageClass::FaceVarying:
    case StorageClass::FaceVertex:
        return face_varying;
    }
    return 1;
}

ClassCounts class_counts(const Shape& shape, const Basis& basis) {
    if (const auto* p = std::get_if<Polygons>(&shape)) {
        const std::size_t vertices = num_indexed(p->vertices).value_or(0);
        return {p->num_loops.size(), vertices, vertices, p->vertices.size()};
    }
    if (const auto* p = std::get_if<Patches>(&shape)) {
        return patch_counts(*p, basis);
    }
    if (const auto* p = std::get_if<NuPatch>(&shape)) {
        return nu_patch_counts(*p);
    }
    if (const auto* m = std::get_if<SubdivisionMesh>(&shape)) {
        const std::size_t vertices = num_indexed(m->vertices).value_or(0);
        return {m->num_vertices.size(), vertices, vertices, m->vertices.size()};
    }
    if (const auto* p = std::get_if<Points>(&shape)) {
        return {1, p->count, p->count, p->count};
    }
    if (const auto* c = std::get_if<Curves>(&shape)) {
        return curve_counts(*c, basis);
    }
    if (const auto* b = std::get_if<Blobby>(&shape)) {
        const auto leaves = static_cast<std::size_t>(b->num_leaves);
        return {1, leaves, leaves, leaves};
    }
    return {};
}

bool check_primitive(Primitive& primitive, const Basis& basis, std::string_view name,
                     base::Diag& diag) {
    const Judge to{diag, name, primitive.pos};
    const bool shape_good =
        std::visit([&](auto& shape) { return judge(shape, to, basis); }, primitive.shape);
    return shape_good && judge_params(primitive, basis, to);
}

std::string trim_curve_fault(const TrimCurve& t) {
    const std::optional<std::size_t> curves = sum_of(t.ncurves);
    const std::optional<std::size_t> points = sum_of(t.n);
    if (!curves || !points) {
        return "a count is negative";
    }
    if (t.order.size() != *curves || t.min.size() != *curves || t.max.size() != *curves ||
        t.n.size() != *curves) {
        return "order, min, max and n must have one value for each of " + num(*curves) + " curves";
    }
    if (t.u.size() != *points || t.v.size() != *points || t.w.size() != *points) {
        return "u, v and w must have one value for each of " + num(*points) + " points";
    }
    std::size_t knots = 0;
    for (std::size_t i = 0; i < *curves; ++i) {
        if (t.order[i] < 1 || t.order[i] > t.n[i]) {
            return "an order does not fit its number of points";
        }
        const std::size_t count =
            static_cast<std::size_t>(t.order[i]) + static_cast<std::size_t>(t.n[i]);
        if (knots + count > t.knot.size()) {
            return "too few knots";
        }
        const auto begin = t.knot.begin() + static_cast<std::ptrdiff_t>(knots);
        if (!std::is_sorted(begin, begin + static_cast<std::ptrdiff_t>(count)) ||
            !(t.min[i] <= t.max[i])) {
            return "knots or the range of a curve decrease";
        }
        knots += count;
    }
    return knots == t.knot.size() ? "" : "too many knots";
}

namespace {

bool same_shape_topology(const Polygons& a, const Polygons& b) {
    return a.num_loops == b.num_loops && a.num_vertices == b.num_vertices &&
           a.vertices == b.vertices;
}
bool same_shape_topology(const Patches& a, const Patches& b) {
    return a.bicubic == b.bicubic && a.is_mesh == b.is_mesh && a.nu == b.nu && a.nv == b.nv &&
           a.uperiodic == b.uperiodic && a.vperiodic == b.vperiodic;
}
bool same_shape_topology(const NuPatch& a, const NuPatch& b) {
    return a.nu == b.nu && a.nv == b.nv && a.uorder == b.uorder && a.vorder == b.vorder;
}
bool same_shape_topology(const SubdivisionMesh& a, const SubdivisionMesh& b) {
    return a.scheme == b.scheme && a.num_vertices == b.num_vertices && a.vertices == b.vertices &&
           a.tags == b.tags && a.num_args == b.num_args && a.int_args == b.int_args;
}
bool same_shape_topology(const Points& a, const Points& b) {
    return a.count == b.count;
}
bool same_shape_topology(const Curves& a, const Curves& b) {
    return a.cubic == b.cubic && a.periodic == b.periodic && a.num_vertices == b.num_vertices;
}
bool same_shape_topology(const Blobby& a, const Blobby& b) {
    return a.code == b.code && a.floats.size() == b.floats.size() && a.strings == b.strings;
}
bool same_shape_topology(const Quadric& a, const Quadric& b) {
    return a.kind == b.kind;
}
bool same_shape_topology(const Geometry& a, const Geometry& b) {
    return a.name == b.name;
}
bool same_shape_topology(const Procedural&, const Procedural&) {
    return false; // may not move
}

} // namespace

bool same_topology(const Primitive& a, const Primitive& b) {
    if (a.shape.index() != b.shape.index() || a.params.params.size() != b.params.params.size()) {
        return false;
    }
    for (std::size_t i = 0; i < a.params.params.size(); ++i) {
        const Param &p = a.params.params[i], &q = b.params.params[i];
        if (p.name != q.name || !(p.decl == q.decl) || p.floats.size() != q.floats.size() ||
            p.ints.size() != q.ints.size() || p.strings != q.strings) {
            return false;
        }
    }
    return std::visit(
        [](const auto& x, const auto& y) {
            if constexpr (std::is_same_v<decltype(x), decltype(y)>) {
                return same_shape_topology(x, y);
            } else {
                return false;
            }
        },
        a.shape, b.shape);
}

} // namespace rib
