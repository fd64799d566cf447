// SPDX-License-Identifier: Apache-2.0
#include "tracer/point_cloud.h"

#include "runtime/base/file.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <compare>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>

namespace trace {

namespace {

// Baked numbers a file may hold: 1 GB. Points of a file that is read: the same.
constexpr std::size_t max_numbers = std::size_t{1} << 28;
constexpr std::size_t max_stride = PointCloud::head + 3 * SL_POINT_CHANNELS_MAX;
constexpr const char* head_names[PointCloud::head] = {"x", "y", "z", "nx", "ny", "nz", "radius"};

int components_of(int type) {
    return type == SL_TYPE_float ? 1 : 3;
}

std::vector<PointCloud::Channel> channels_of(const sl_point_query& query) {
    std::vector<PointCloud::Channel> channels;
    std::size_t offset = PointCloud::head;
    for (int k = 0; k < query.num_channels; ++k) {
        const int n = components_of(query.channel[k].type);
        channels.push_back({query.channel[k].name, n, offset});
        offset += static_cast<std::size_t>(n);
    }
    return channels;
}

bool alike(const std::vector<PointCloud::Channel>& a, const std::vector<PointCloud::Channel>& b) {
    return std::ranges::equal(a, b, [](const auto& x, const auto& y) {
        return x.name == y.name && x.components == y.components;
    });
}

std::array<float, 3> triple_at(const float* planes, std::uint32_t lanes, std::uint32_t lane) {
    return {planes[lane], planes[lanes + lane], planes[2 * lanes + lane]};
}

base::V3d wide(const std::array<float, 3>& a) {
    return base::V3d(base::V3f(a[0], a[1], a[2]));
}

std::array<float, 3> narrow(const base::V3d& a) {
    return {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)};
}

struct PointAt {
    std::array<float, 3> P{}, N{};
};

PointAt point_at(const sl_point_query& q, const base::Mat4& m, const base::Mat4& inverse,
                 std::uint32_t lane) {
    if (q.num_at == 2) {
        return {{q.at[lane], q.at[q.lanes + lane], 0}, {0, 0, 0}};
    }
    PointAt out;
    out.P = narrow(base::point(m, wide(triple_at(q.at, q.lanes, lane))));
    out.N = narrow(base::normalize(
        base::normal_by_inverse(inverse, wide(triple_at(q.at + 3 * q.lanes, q.lanes, lane)))));
    return out;
}

// Points in an order of their own: lexicographic.
std::vector<std::uint32_t> sorted_points(const PointCloud& cloud) {
    std::vector<std::uint32_t> order(cloud.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) {
        order[i] = i;
    }
    std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
        return std::lexicographical_compare(
            cloud.point(a), cloud.point(a) + cloud.stride, cloud.point(b),
            cloud.point(b) + cloud.stride,
            [](float x, float y) { return std::strong_order(x, y) < 0; }); // NaN has a place too
    });
    return order;
}

std::string number_text(float x) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.9g", static_cast<double>(x));
    return text.data();
}

std::string bake_text(const PointCloud& cloud) {
    const std::vector<std::uint32_t> order = sorted_points(cloud);
    std::string text = "# s t value ...\n";
    for (const std::uint32_t i : order) {
        const float* p = cloud.point(i);
        text += number_text(p[0]) + " " + number_text(p[1]);
        for (std::size_t k = PointCloud::head; k < cloud.stride; ++k) {
            text += " " + number_text(p[k]);
        }
        text += '\n';
    }
    return text;
}

} // namespace

const PointCloud::Channel* PointCloud::find(std::string_view name) const {
    const auto it = std::ranges::find(channels, name, &Channel::name);
    return it == channels.end() ? nullptr : &*it;
}

// --- PLY

std::string ply_text(const PointCloud& cloud) {
    static_assert(std::endian::native == std::endian::little);
    const std::vector<std::uint32_t> order = sorted_points(cloud);
    std::string text = "ply\nformat binary_little_endian 1.0\ncomment Perigee point cloud\n";
    for (const PointCloud::Channel& c : cloud.channels) {
        text += "comment channel " + std::to_string(c.components) + " " + c.name + "\n";
    }
    text += "element vertex " + std::to_string(cloud.size()) + "\n";
    for (const char* name : head_names) {
        text += std::string("property float ") + name + "\n";
    }
    for (const PointCloud::Channel& c : cloud.channels) {
        for (int k = 0; k < c.components; ++k) {
            text += "property float " + c.name +
                    (c.components > 1 ? "_" + std::to_string(k) : std::string()) + "\n";
        }
    }
    text += "end_header\n";
    for (const std::uint32_t i : order) {
        text.append(reinterpret_cast<const char*>(cloud.point(i)), cloud.stride * sizeof(float));
    }
    return text;
}

namespace {

struct PlyHeader {
    std::size_t num_points = 0;
    std::vector<std::string> properties;
    std::vector<PointCloud::Channel> channels; // of the comments
};

bool take_header_line(const std::string& line, PlyHeader& h) {
    std::istringstream words(line);
    std::string first, second, third;
    words >> first >> second >> third;
    if (first == "comment") {
        int n = 0;
        if (second == "channel" && (n = std::atoi(third.c_str())) > 0 && n <= 3 &&
            h.channels.size() < SL_POINT_CHANNELS_MAX) {
            std::string name;
            words >> name;
            h.channels.push_back({name, n, 0});
        }
        return true;
    }
    if (first == "format") {
        return second == "binary_little_endian";
    }
    if (first == "element") {
        h.num_points = std::strtoull(third.c_str(), nullptr, 10);
        return second == "vertex";
    }
    if (first == "property") {
        h.properties.push_back(third);
        return (second == "float" || second == "float32") && h.properties.size() <= max_stride;
    }
    return first == "ply";
}

bool read_header(std::istream& file, PlyHeader& h) {
    std::string line;
    for (int i = 0; i < 256 && std::getline(file, line); ++i) {
        if (line == "end_header") {
            return true;
        }
        if (line.size() > 1024 || !take_header_line(line, h)) {
            return false;
        }
    }
    return false;
}

// The head as written here, the channels one after the other.
bool place_channels(const PlyHeader& h, PointCloud& cloud) {
    if (h.properties.size() < PointCloud::head ||
        !std::equal(std::begin(head_names), std::end(head_names), h.properties.begin())) {
        return false;
    }
    cloud.channels = h.channels;
    std::size_t offset = PointCloud::head;
    for (PointCloud::Channel& c : cloud.channels) {
        c.offset = offset;
        offset += static_cast<std::size_t>(c.components);
    }
    cloud.stride = h.properties.size();
    return offset <= cloud.stride;
}

} // namespace

std::optional<PointCloud> read_ply(const std::string& path, std::string& error) {
    std::ifstream file(path, std::ios::binary);
    PlyHeader h;
    PointCloud cloud;
    if (!file || !read_header(file, h) || !place_channels(h, cloud) ||
        h.num_points > max_numbers / cloud.stride) {
        error = !file ? "no such file" : "it is no point cloud of bake3d()";
        return std::nullopt;
    }
    // By blocks: the header may lie about the number of points.
    constexpr std::size_t block = 4096;
    for (std::size_t done = 0; done < h.num_points;) {
        const std::size_t now = std::min(block, h.num_points - done);
        const std::size_t at = cloud.numbers.size();
        cloud.numbers.resize(at + now * cloud.stride);
        if (!file.read(reinterpret_cast<char*>(cloud.numbers.data() + at),
                       static_cast<std::streamsize>(now * cloud.stride * sizeof(float)))) {
            error = "it ends too early";
            return std::nullopt;
        }
        done += now;
    }
    return cloud;
}

// --- nearest points

struct PointTree::Search {
    std::array<float, 3> P, N;
    float limit2;
    std::span<Near, most_near> found;
    std::size_t count = 0;
};

PointTree::PointTree(PointCloud cloud) : cloud_(std::move(cloud)) {
    for (std::uint32_t i = 0; i < cloud_.size(); ++i) { // NaN has no place in a tree
        const float* p = cloud_.point(i);
        if (std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2])) {
            order_.push_back(i);
        }
    }
    build(0, static_cast<std::uint32_t>(order_.size()), 0);
}

void PointTree::build(std::uint32_t begin, std::uint32_t end, int axis) {
    if (end - begin < 2) {
        return;
    }
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) {
                         return cloud_.point(a)[axis] < cloud_.point(b)[axis];
                     });
    build(begin, middle, (axis + 1) % 3);
    build(middle + 1, end, (axis + 1) % 3);
}

void PointTree::search(Search& s, std::uint32_t begin, std::uint32_t end, int axis) const {
    if (begin >= end) {
        return;
    }
    const std::uint32_t middle = begin + (end - begin) / 2;
    const float* p = cloud_.point(order_[middle]);
    const float d[3] = {s.P[0] - p[0], s.P[1] - p[1], s.P[2] - p[2]};
    const float distance2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    const bool same_side = s.N[0] * p[3] + s.N[1] * p[4] + s.N[2] * p[5] >= 0;
    if (distance2 <= s.limit2 && same_side) {
        std::size_t at = s.count < most_near ? s.count++ : most_near - 1;
        for (; at > 0 && s.found[at - 1].distance2 > distance2; --at) {
            s.found[at] = s.found[at - 1];
        }
        s.found[at] = {distance2, order_[middle]};
        if (s.count == most_near) {
            s.limit2 = s.found[most_near - 1].distance2;
        }
    }
    const float offset = d[axis];
    const int next = (axis + 1) % 3;
    const bool low_first = offset < 0;
    for (const bool low : {low_first, !low_first}) {
        if (low != low_first && offset * offset > s.limit2) {
            continue; // nothing nearer beyond the plane
        }
        low ? search(s, begin, middle, next) : search(s, middle + 1, end, next);
    }
}

std::size_t PointTree::nearest(const std::array<float, 3>& P, const std::array<float, 3>& N,
                               float radius, std::span<Near, most_near> out) const {
    if (!std::isfinite(P[0] + P[1] + P[2])) {
        return 0;
    }
    Search s{P, N, radius > 0 ? radius * radius : INFINITY, out, 0};
    search(s, 0, static_cast<std::uint32_t>(order_.size()), 0);
    return s.count;
}

// --- files

std::uint32_t PointFiles::add(const sl_point_query& q, const base::Mat4& file_from_current) {
    const base::Mat4 inverse = base::inverse(file_from_current).value_or(base::Mat4{});
    const std::lock_guard lock(mutex_);
    const auto [it, is_new] = baked_.try_emplace(q.file);
    Baked& baked = it->second;
    if (is_new) {
        baked.num_at = q.num_at;
        baked.cloud.channels = channels_of(q);
        for (const PointCloud::Channel& c : baked.cloud.channels) {
            baked.cloud.stride += static_cast<std::size_t>(c.components);
        }
    }
    baked.full |= baked.cloud.numbers.size() > max_numbers;
    if (baked.full || baked.num_at != q.num_at || !alike(baked.cloud.channels, channels_of(q))) {
        return 0;
    }
    for (std::uint32_t rest = q.mask; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(rest));
        const PointAt at = point_at(q, file_from_current, inverse, lane);
        std::vector<float>& out = baked.cloud.numbers;
        out.insert(out.end(), at.P.begin(), at.P.end());
        out.insert(out.end(), at.N.begin(), at.N.end());
        out.push_back(q.radius * q.radius_scale);
        for (int k = 0; k < q.num_channels; ++k) {
            for (int c = 0; c < components_of(q.channel[k].type); ++c) {
                out.push_back(q.channel[k].values[static_cast<std::uint32_t>(c) * q.lanes + lane]);
            }
        }
    }
    return q.mask;
}

std::shared_ptr<const PointTree> PointFiles::tree(const std::string& path, std::string& error) {
    const std::lock_guard lock(mutex_);
    const auto [it, is_new] = trees_.try_emplace(path);
    if (is_new) {
        std::optional<PointCloud> cloud = read_ply(path, error);
        it->second = cloud ? std::make_shared<const PointTree>(std::move(*cloud)) : nullptr;
    }
    return it->second;
}

namespace {

// Weights fall from 1 at the place to 0 at the farthest point of those found.
void blend(const PointCloud& cloud, std::span<const PointTree::Near> near, std::uint32_t lane,
           const sl_point_query& q) {
    const float far2 = near.back().distance2;
    std::array<float, PointTree::most_near> weight{};
    float sum = 0;
    for (std::size_t i = 0; i < near.size(); ++i) {
        const float part = far2 > 0 ? std::sqrt(near[i].distance2 / far2) : 0;
        weight[i] = near.size() == 1 ? 1 : (1 - part) * (1 - part);
        sum += weight[i];
    }
    if (!(sum > 0)) { // all are equally far
        weight.fill(1);
        sum = static_cast<float>(near.size());
    }
    for (int k = 0; k < q.num_channels; ++k) {
        const PointCloud::Channel* c = cloud.find(q.channel[k].name);
        if (c == nullptr || c->components != components_of(q.channel[k].type)) {
            continue; // stays as it is
        }
        for (int j = 0; j < c->components; ++j) {
            float value = 0;
            for (std::size_t i = 0; i < near.size(); ++i) {
                value += weight[i] / sum *
                         cloud.point(near[i].point)[c->offset + static_cast<std::size_t>(j)];
            }
            q.channel[k].values[static_cast<std::uint32_t>(j) * q.lanes + lane] = value;
        }
    }
}

} // namespace

std::uint32_t PointFiles::lookup(const std::string& path, const sl_point_query& q,
                                 const base::Mat4& file_from_current, std::string& error) {
    const std::shared_ptr<const PointTree> points = tree(path, error);
    if (points == nullptr) {
        return 0;
    }
    const base::Mat4 inverse = base::inverse(file_from_current).value_or(base::Mat4{});
    std::uint32_t set = 0;
    for (std::uint32_t rest = q.mask; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(rest));
        const PointAt at = point_at(q, file_from_current, inverse, lane);
        std::array<PointTree::Near, PointTree::most_near> near;
        const std::size_t count = points->nearest(at.P, at.N, q.radius * q.radius_scale, near);
        if (count > 0) {
            blend(points->cloud(), std::span(near).first(count), lane, q);
            set |= 1U << lane;
        }
    }
    return set;
}

std::vector<PointFiles::Failure> PointFiles::write() {
    std::vector<Failure> failures;
    const std::lock_guard lock(mutex_);
    for (const auto& [path, baked] : baked_) {
        const std::string text = baked.num_at == 2 ? bake_text(baked.cloud) : ply_text(baked.cloud);
        std::string why = base::write_file_atomically(path, text);
        if (why.empty() && baked.full) {
            why = "more samples than a file may hold: the rest is left out";
        }
        if (!why.empty()) {
            failures.push_back({path, why});
        }
    }
    baked_.clear();
    return failures;
}

void PointFiles::discard() {
    const std::lock_guard lock(mutex_);
    baked_.clear();
}

void PointFiles::forget() {
    const std::lock_guard lock(mutex_);
    trees_.clear();
}

} // namespace trace
