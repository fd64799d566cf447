// SPDX-License-Identifier: Apache-2.0
// Samples that shaders bake (bake, bake3d) and read again (texture3d), sl.md 4.9. In: samples from
// any thread. Out: a text file of s, t and values, or a point cloud as PLY, in an order that does
// not depend on who came first; values interpolated from the nearest points. Formats:
// docs/textures.md.
#pragma once

#include "runtime/abi/sl_abi.h"
#include "runtime/base/mat.h"

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace trace {

// A point cloud: per point P, N, radius, then the channels' numbers.
struct PointCloud {
    static constexpr std::size_t head = 7;
    struct Channel {
        std::string name;
        int components = 1;
        std::size_t offset = 0; // within a point
    };
    std::vector<Channel> channels;
    std::size_t stride = head; // numbers per point
    std::vector<float> numbers;

    [[nodiscard]] std::size_t size() const { return numbers.size() / stride; }
    [[nodiscard]] const float* point(std::size_t i) const { return numbers.data() + i * stride; }
    [[nodiscard]] const Channel* find(std::string_view name) const;
};

[[nodiscard]] std::optional<PointCloud> read_ply(const std::string& path, std::string& error);
[[nodiscard]] std::string ply_text(const PointCloud& cloud);

// Finds the points near a place: a balanced k-d tree [Bentley75].
class PointTree {
public:
    explicit PointTree(PointCloud cloud);

    [[nodiscard]] const PointCloud& cloud() const { return cloud_; }
    struct Near {
        float distance2 = 0;
        std::uint32_t point = 0;
    };
    static constexpr std::size_t most_near = 8;
    // The nearest points on the side of N (0 0 0: any) no farther than radius (0: any), nearest
    // first. Returns how many.
    std::size_t nearest(const std::array<float, 3>& P, const std::array<float, 3>& N, float radius,
                        std::span<Near, most_near> out) const;

private:
    struct Search;
    void build(std::uint32_t begin, std::uint32_t end, int axis);
    void search(Search& s, std::uint32_t begin, std::uint32_t end, int axis) const;

    PointCloud cloud_;
    std::vector<std::uint32_t> order_; // the middle of each range splits it
};

// The files of a run. add() and lookup() from any thread; the rest between frames.
class PointFiles {
public:
    // Keeps the samples until write(). Returns the lanes taken; what differs from the file's first
    // sample in its channels is not.
    std::uint32_t add(const sl_point_query& query, const base::Mat4& file_from_current);
    // Sets the channels' planes where points are near. error: the file cannot be read.
    std::uint32_t lookup(const std::string& path, const sl_point_query& query,
                         const base::Mat4& file_from_current, std::string& error);

    struct Failure {
        std::string path, why;
    };
    // Writes what was added since the last time.
    [[nodiscard]] std::vector<Failure> write();
    void discard(); // without writing
    // Files may have changed on disk.
    void forget();

private:
    struct Baked {
        int num_at = 2;
        PointCloud cloud; // of bake(): P.xy are s and t
        bool full = false;
    };
    [[nodiscard]] std::shared_ptr<const PointTree> tree(const std::string& path,
                                                        std::string& error);

    std::mutex mutex_;
    std::map<std::string, Baked> baked_;
    std::map<std::string, std::shared_ptr<const PointTree>> trees_; // null: not readable
};

} // namespace trace
