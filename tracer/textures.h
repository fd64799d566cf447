// SPDX-License-Identifier: Apache-2.0
// The maps of a run. In: paths, and requests to make maps. Out: pictures behind OpenImageIO's
// TextureSystem (the module is opened when the first one is asked for), shadow maps and cube
// environments held in memory. A map is read once and again only after it changed on disk. Safe
// from any thread; begin_frame(), changed() and write_samples() between frames only.
#pragma once

#include "ribtools/scene.h"
#include "runtime/base/diag.h"
#include "tracer/cube_map.h"
#include "tracer/point_cloud.h"
#include "tracer/shadow_map.h"
#include "tracer/texture_module.h"

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace trace {

struct Picture {
    void* file = nullptr; // null: not readable
    perigee_texture_info info{};
};

using ShadowMaps = std::vector<ShadowMap>; // one, or a set of them for occlusion()

// OpenImageIO's part; null with the reason in error.
[[nodiscard]] const perigee_textures* texture_module(std::string& error);

// Paths to try for a map's name: as given, then in the directories, then both with ".tx". Names
// that start with "/", "./" or "../" are not looked for in directories.
[[nodiscard]] std::optional<std::string> find_map(const std::string& name,
                                                  const std::vector<std::string>& directories);

class Textures {
public:
    Textures() = default;
    ~Textures();
    Textures(const Textures&) = delete;
    Textures& operator=(const Textures&) = delete;

    // Each returns what cannot be read as null and says why.
    [[nodiscard]] Picture picture(const std::string& path, std::string& error);
    [[nodiscard]] std::shared_ptr<const ShadowMaps> shadows(const std::string& path,
                                                            std::string& error);
    [[nodiscard]] std::shared_ptr<const CubeMap> cube(const std::string& path, std::string& error);
    // A lookup of one packet; false: some lane failed.
    [[nodiscard]] bool lookup(const perigee_texture_query& query, std::string& error) const;

    // Memory for tiles of pictures; files that changed on disk are read again.
    void begin_frame(const rib::Options& options);
    // A file was made: what was read from it is forgotten.
    void changed(const std::string& path);

    [[nodiscard]] PointFiles& points() { return points_; }

    struct Memory {
        std::uint64_t tile_bytes = 0, map_bytes = 0, bytes_read = 0;
    };
    [[nodiscard]] Memory memory() const;

private:
    struct Stamp { // tells whether a file is still the same
        std::int64_t time = 0;
        std::uint64_t size = 0;
        friend bool operator==(const Stamp&, const Stamp&) = default;
    };
    template <class Map> struct Held {
        std::shared_ptr<const Map> map;
        Stamp stamp;
    };
    template <class Map> using Shelf = std::map<std::string, Held<Map>>;
    template <class Map, class Read>
    std::shared_ptr<const Map> get(Shelf<Map>& shelf, const std::string& path, const Read& read);
    template <class Map> static void drop_changed(Shelf<Map>& shelf);
    [[nodiscard]] static Stamp stamp_of(const std::string& path);
    void* system(std::string& error);

    mutable std::mutex mutex_;
    const perigee_textures* module_ = nullptr;
    void* system_ = nullptr;
    float memory_mb_ = 0;
    Shelf<ShadowMaps> shadows_;
    Shelf<CubeMap> cubes_;
    PointFiles points_;
};

} // namespace trace
