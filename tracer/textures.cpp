// SPDX-License-Identifier: Apache-2.0
#include "tracer/textures.h"

#include "ribtools/search_path.h"
#include "runtime/base/module.h"

#include <algorithm>
#include <array>
#include <filesystem>

namespace trace {

namespace {

// What tiles may take where Option "limits" "texturememory" says nothing, and the least that it may
// say: files of the nineties ask for one or two megabytes.
constexpr float default_memory_mb = 512, least_memory_mb = 16;

bool is_file(const std::string& path) {
    std::error_code error;
    return std::filesystem::exists(path, error) && !std::filesystem::is_directory(path, error);
}

float memory_of(const rib::Options& options) {
    const auto it = options.user.find("limits:texturememory");
    if (it == options.user.end() || (it->second.ints.empty() && it->second.floats.empty())) {
        return default_memory_mb;
    }
    const double kilobytes = it->second.ints.empty()
                                 ? static_cast<double>(it->second.floats.front())
                                 : static_cast<double>(it->second.ints.front());
    return std::max(static_cast<float>(kilobytes / 1024), least_memory_mb);
}

} // namespace

const perigee_textures* texture_module(std::string& error) {
    const base::ModuleSymbol symbol = base::open_module("perigee_oiio", PERIGEE_OIIO_TEXTURES);
    if (symbol.address == nullptr) {
        error = symbol.error;
        return nullptr;
    }
    return reinterpret_cast<perigee_textures_function>(symbol.address)();
}

std::optional<std::string> find_map(const std::string& name,
                                    const std::vector<std::string>& directories) {
    for (const std::string& suffix : {std::string(), std::string(".tx")}) {
        const std::string file = name + suffix;
        if (is_file(file)) {
            return file;
        }
        if (rib::bypasses_search_path(name)) {
            continue;
        }
        for (const std::string& directory : directories) {
            std::string path = directory;
            path += '/';
            path += file;
            if (is_file(path)) {
                return path;
            }
        }
    }
    return std::nullopt;
}

Textures::~Textures() {
    if (system_ != nullptr) {
        module_->destroy(system_);
    }
}

// With the lock held.
void* Textures::system(std::string& error) {
    if (module_ == nullptr) {
        module_ = texture_module(error);
    }
    if (module_ != nullptr && system_ == nullptr) {
        std::array<char, 256> text{};
        system_ = module_->create(text.data(), text.size());
        error = text.data();
        if (system_ != nullptr) {
            module_->set_memory(system_, memory_mb_ > 0 ? memory_mb_ : default_memory_mb);
        }
    }
    return system_;
}

Picture Textures::picture(const std::string& path, std::string& error) {
    const std::lock_guard lock(mutex_);
    Picture picture;
    if (void* ts = system(error)) {
        std::array<char, 512> text{};
        picture.file = module_->open(ts, path.c_str(), &picture.info, text.data(), text.size());
        error = text.data();
    }
    return picture;
}

bool Textures::lookup(const perigee_texture_query& query, std::string& error) const {
    std::array<char, 512> text{};
    const bool good = module_->lookup(system_, &query, text.data(), text.size()) != 0;
    if (!good) {
        error = text.data();
    }
    return good;
}

Textures::Stamp Textures::stamp_of(const std::string& path) {
    std::error_code error;
    const auto time = std::filesystem::last_write_time(path, error);
    const auto size = std::filesystem::file_size(path, error);
    return error ? Stamp{} : Stamp{time.time_since_epoch().count(), size};
}

template <class Map, class Read>
std::shared_ptr<const Map> Textures::get(Shelf<Map>& shelf, const std::string& path,
                                         const Read& read) {
    const std::lock_guard lock(mutex_);
    if (const auto it = shelf.find(path); it != shelf.end()) {
        return it->second.map;
    }
    std::shared_ptr<const Map> map = read();
    if (map != nullptr) {
        shelf.emplace(path, Held<Map>{map, stamp_of(path)});
    }
    return map;
}

std::shared_ptr<const ShadowMaps> Textures::shadows(const std::string& path, std::string& error) {
    return get(shadows_, path, [&]() -> std::shared_ptr<const ShadowMaps> {
        const std::optional<MapFile> file = read_map_file(path, error);
        if (!file) {
            return nullptr;
        }
        auto maps = std::make_shared<ShadowMaps>();
        for (const MapImage& image : file->images) {
            if (image.has_matrices) {
                maps->emplace_back(image);
            }
        }
        if (maps->empty()) {
            error = "it is no shadow map: it does not say where it was seen from";
            return nullptr;
        }
        return maps;
    });
}

std::shared_ptr<const CubeMap> Textures::cube(const std::string& path, std::string& error) {
    return get(cubes_, path, [&]() -> std::shared_ptr<const CubeMap> {
        const std::optional<MapFile> file = read_map_file(path, error);
        if (!file) {
            return nullptr;
        }
        if (file->images.empty() || !CubeMap::fits(file->images.front())) {
            error = "it is no cube environment: its picture is not 3 by 2 square faces";
            return nullptr;
        }
        return std::make_shared<const CubeMap>(file->images.front());
    });
}

template <class Map> void Textures::drop_changed(Shelf<Map>& shelf) {
    std::erase_if(shelf,
                  [](const auto& item) { return !(item.second.stamp == stamp_of(item.first)); });
}

void Textures::begin_frame(const rib::Options& options) {
    const std::lock_guard lock(mutex_);
    memory_mb_ = memory_of(options);
    drop_changed(shadows_);
    drop_changed(cubes_);
    if (system_ != nullptr) {
        module_->set_memory(system_, memory_mb_);
        module_->invalidate(system_, nullptr);
    }
    points_.forget();
}

void Textures::changed(const std::string& path) {
    const std::lock_guard lock(mutex_);
    shadows_.erase(path);
    cubes_.erase(path);
    if (system_ != nullptr) {
        module_->invalidate(system_, path.c_str());
    }
}

Textures::Memory Textures::memory() const {
    const std::lock_guard lock(mutex_);
    Memory memory;
    for (const auto& [path, held] : shadows_) {
        for (const ShadowMap& map : *held.map) {
            memory.map_bytes += map.bytes();
        }
    }
    for (const auto& [path, held] : cubes_) {
        memory.map_bytes += held.map->bytes();
    }
    if (system_ != nullptr) {
        perigee_texture_stats stats{};
        module_->stats(system_, &stats);
        memory.tile_bytes = stats.tile_bytes;
        memory.bytes_read = stats.bytes_read;
    }
    return memory;
}

} // namespace trace
