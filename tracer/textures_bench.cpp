// SPDX-License-Identifier: Apache-2.0
// Nanoseconds per lookup of each kind of map as the engine asks for it, one thread, the map in
// memory. Prints JSON lines (docs/benchmarks.md).
#include "runtime/base/temp_dir.h"
#include "tracer/texture_frame.h"
#include "tracer/texture_make.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;

constexpr int size = 1024, num_packets = 4000;

float next(std::uint32_t& state) {
    state = state * 1664525U + 1013904223U;
    return static_cast<float>(state >> 8) / 16777216.0f;
}

bool write_noise(const std::string& path) {
    trace::MapFile map;
    trace::MapImage image;
    image.width = image.height = size;
    image.num_channels = 3;
    std::uint32_t state = 1;
    image.values.resize(std::size_t{3} * size * size);
    std::ranges::generate(image.values, [&] { return next(state); });
    map.images.push_back(std::move(image));
    base::OutputFile file(path);
    std::string error;
    return trace::write_map_file(map, file, error) && file.commit();
}

bool write_shadow(const std::string& path) {
    trace::MapFile map{std::string(trace::shadow_format), {}};
    trace::MapImage image;
    image.width = image.height = size;
    image.has_matrices = true;
    for (int i = 0; i < 16; i += 5) {
        image.camera_from_world[i] = 1;
    }
    const float screen[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, -1, 0};
    std::copy_n(screen, 16, image.screen_from_world);
    std::uint32_t state = 1;
    image.values.resize(std::size_t{size} * size);
    std::ranges::generate(image.values, [&] { return 3 + 3 * next(state); });
    map.images.push_back(std::move(image));
    base::OutputFile file(path);
    std::string error;
    return trace::write_map_file(map, file, error) && file.commit();
}

struct Row {
    const char* name;
    int kind;
    const char* file;
    float width; // of the footprint along u; a quarter of it along v
    float blur;
};

// Packets of eight places that lie beside each other.
std::vector<sl_map_query> queries(const Row& row, const std::string& file) {
    std::vector<sl_map_query> all(num_packets);
    std::uint32_t state = 7;
    for (sl_map_query& q : all) {
        q = {};
        q.kind = row.kind;
        q.num_channels = row.kind == SL_MAP_shadow ? 1 : 3;
        q.lanes = 8;
        q.mask = 0xff;
        const float x = next(state), y = next(state);
        for (int lane = 0; lane < 8; ++lane) {
            const float step = static_cast<float>(lane) * row.width;
            q.name[lane] = file.c_str();
            const bool flat = row.kind == SL_MAP_texture;
            q.at[lane] = flat ? x + step : 2 * x - 1 + step;
            q.at[8 + lane] = flat ? y : 2 * y - 1;
            q.at[16 + lane] = row.kind == SL_MAP_shadow ? 5 : 1;
            q.du[lane] = row.width;
            q.dv[8 + lane] = row.width / 4;
            q.option[SL_MAP_OPTION_swidth][lane] = q.option[SL_MAP_OPTION_twidth][lane] = 1;
            q.option[SL_MAP_OPTION_sblur][lane] = q.option[SL_MAP_OPTION_tblur][lane] = row.blur;
            q.option[SL_MAP_OPTION_samples][lane] = 16;
        }
    }
    return all;
}

double best_ns(const trace::TextureFrame& frame, const std::vector<sl_map_query>& all) {
    double best = 1e30;
    float result[24] = {};
    for (int run = 0; run < 5; ++run) {
        const auto start = Clock::now();
        for (const sl_map_query& q : all) {
            frame.lookup(
                q, {}, [](const std::string& text) { std::puts(text.c_str()); }, result);
        }
        const std::chrono::duration<double, std::nano> spent = Clock::now() - start;
        best = std::min(best, spent.count() / (8.0 * num_packets));
    }
    return best;
}

} // namespace

int main() {
    std::string error;
    const base::TempDir directory("perigee-bench");
    const std::string plain = directory.path() + "/noise.tif",
                      made = directory.path() + "/noise.tx",
                      shadow = directory.path() + "/noise.shd";
    if (trace::texture_module(error) == nullptr) {
        std::printf("no OpenImageIO: %s\n", error.c_str());
        return 0;
    }
    trace::MakeRequest make;
    make.sources = {plain};
    make.target = made;
    if (!write_noise(plain) || !write_shadow(shadow) || !trace::make_map(make).made) {
        std::puts("cannot write the maps");
        return 1;
    }
    constexpr float texel = 1.0f / size;
    const Row rows[] = {
        {"texture, a texel", SL_MAP_texture, made.c_str(), texel, 0},
        {"texture, 8 by 2 texels", SL_MAP_texture, made.c_str(), 8 * texel, 0},
        {"texture, blur .05", SL_MAP_texture, made.c_str(), texel, .05f},
        {"environment", SL_MAP_environment, made.c_str(), 4 * texel, 0},
        {"shadow, a texel", SL_MAP_shadow, shadow.c_str(), .1f * texel, 0},
        {"shadow, blur .02, 16 samples", SL_MAP_shadow, shadow.c_str(), texel, .02f},
    };
    trace::Textures textures;
    const trace::TextureFrame frame(textures, {}, {});
    for (const Row& row : rows) {
        const std::string file = row.file;
        const std::vector<sl_map_query> all = queries(row, file);
        std::printf("{\"name\": \"%s\", \"value\": %.1f, \"unit\": \"ns/lookup\", \"note\": "
                    "\"three channels, 1024 x 1024\"}\n",
                    row.name, best_ns(frame, all));
    }
    const trace::Textures::Memory memory = textures.memory();
    std::printf(
        "{\"name\": \"texture tiles of 1024 x 1024 x 3 floats\", \"value\": %.1f, \"unit\": "
        "\"MB\", \"better\": \"lower\"}\n",
        static_cast<double>(memory.tile_bytes) / 1e6);
    return 0;
}
