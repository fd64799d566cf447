// SPDX-License-Identifier: Apache-2.0
// Map lookups of one frame: the services map, map_info, bake and texture3d of sl_services.def. In:
// queries of packets. Out: filtered values; sl.md 4.7. Names are resolved once per frame; an
// unreadable map is reported once and gives its fallback. Lanes of a packet that name the same map
// go to it together. Safe from any thread.
#pragma once

#include "runtime/abi/sl_abi.h"
#include "runtime/base/mat.h"
#include "tracer/environment_light.h"
#include "tracer/textures.h"

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

namespace trace {

// What Option or Attribute "shadow" say where a shader says nothing.
struct ShadowBias {
    bool given = false;
    float bias[2] = {0, 0};
};
[[nodiscard]] ShadowBias shadow_bias(const std::map<std::string, rib::Param>& user);

class TextureFrame {
public:
    // Reports something about the map of this name, for the user.
    using Report = std::function<void(const std::string& text)>;

    TextureFrame(Textures& textures, const rib::Options& options,
                 const base::Mat4& world_from_current);
    ~TextureFrame();

    void lookup(const sl_map_query& query, const ShadowBias& bias, const Report& report,
                float* result) const;
    // textureinfo(): numbers, or a text; 0 of them: not known, or of another type.
    struct Info {
        std::vector<float> numbers;
        std::string text;
    };
    [[nodiscard]] const Info& info(sl_string name, sl_string key) const;

    [[nodiscard]] const ShadowBias& default_bias() const { return default_bias_; }
    [[nodiscard]] const std::vector<std::string>& directories() const { return directories_; }
    [[nodiscard]] Textures& textures() const { return textures_; }

private:
    enum class Use : std::uint8_t { Picture, Environment, Shadow };
    struct Map;
    struct Key {
        sl_string name;
        Use use;
        friend bool operator==(const Key&, const Key&) = default;
    };
    struct KeyHash {
        std::size_t operator()(const Key& key) const {
            return std::hash<const void*>{}(key.name) * 4 + static_cast<std::size_t>(key.use);
        }
    };

    [[nodiscard]] Info find_info(const std::string& name, std::string_view key) const;
    [[nodiscard]] static Use use_of(int kind);
    [[nodiscard]] const Map& find(const Key& key) const;
    [[nodiscard]] std::unique_ptr<Map> load(const std::string& name, Use use) const;
    void load_shadow(const std::string& path, Map& map) const;
    void load_environment(const std::string& path, Map& map) const;

    void lookup_one(const Map& map, const sl_map_query& query, std::uint32_t mask,
                    const ShadowBias& bias, const Report& report, float* result) const;
    void fall_back(const sl_map_query& query, std::uint32_t mask, float* result) const;
    template <class Put>
    void look_up(const Map& map, const sl_map_query& query, std::uint32_t mask,
                 const Report& report, float* result, Put put) const;
    void texture(const Map& map, const sl_map_query& query, std::uint32_t mask,
                 const Report& report, float* result) const;
    void bump(const Map& map, const sl_map_query& query, std::uint32_t mask, const Report& report,
              float* result) const;
    void latlong(const Map& map, const sl_map_query& query, std::uint32_t mask,
                 const Report& report, float* result) const;
    void cube(const Map& map, const sl_map_query& query, std::uint32_t mask, float* result) const;
    void shadow(const Map& map, const sl_map_query& query, std::uint32_t mask,
                const ShadowBias& bias, float* result) const;
    void irradiance(const Map& map, const sl_map_query& query, std::uint32_t mask,
                    float* result) const;
    [[nodiscard]] Irradiance project(const Map& map) const;
    void ask(const Map& map, perigee_texture_query& query, const Report& report) const;

    Textures& textures_;
    std::vector<std::string> directories_;
    base::Mat4 world_from_current_;
    ShadowBias default_bias_;
    mutable std::shared_mutex mutex_;
    mutable std::unordered_map<Key, std::unique_ptr<Map>, KeyHash> maps_;
    mutable std::mutex info_mutex_;
    mutable std::map<std::pair<sl_string, sl_string>, Info> infos_; // packets ask again and again
};

} // namespace trace
