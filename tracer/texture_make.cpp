// SPDX-License-Identifier: Apache-2.0
#include "tracer/texture_make.h"

#include "runtime/base/file.h"
#include "runtime/base/output_file.h"
#include "tracer/cube_map.h"
#include "tracer/map_file.h"
#include "tracer/point_cloud.h"
#include "tracer/textures.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>

namespace trace {

namespace {

struct FilterName {
    std::string_view ri, oiio;
};
// Pixel filters of ri.md 6.4 and what OpenImageIO calls them.
constexpr FilterName filter_names[] = {
    {"box", ""},
    {"triangle", "triangle"},
    {"gaussian", "gaussian"},
    {"catmull-rom", "catmull-rom"},
    {"sinc", "sinc"},
    {"b-spline", "bspline"},
    {"radial-bspline", "bspline"},
    {"disk", "disk"},
    {"mitchell", "mitchell"},
    {"lanczos", "lanczos3"},
    {"blackman-harris", "blackman-harris"},
    {"bessel", "radial-lanczos3"},
};

std::string oiio_filter(const std::string& name, MakeOutcome& outcome) {
    const auto* row = std::ranges::find(filter_names, std::string_view(name), &FilterName::ri);
    if (row == std::end(filter_names)) {
        outcome.notes.push_back("filter \"" + name + "\" is not known; box is used");
        return "";
    }
    return std::string(row->oiio);
}

std::string wrap_mode(const std::string& name, MakeOutcome& outcome) {
    constexpr std::string_view modes[] = {"black", "periodic", "clamp", "mirror"};
    if (std::ranges::find(modes, std::string_view(name)) == std::end(modes)) {
        outcome.notes.push_back("wrap mode \"" + name + "\" is not known; black is used");
        return "black";
    }
    return name;
}

int take_bytes(void* user, const void* bytes, std::size_t count) {
    return static_cast<base::OutputFile*>(user)->write(bytes, count) ? 1 : 0;
}

void fail(MakeOutcome& outcome, std::string why) {
    outcome.made = false;
    outcome.error = std::move(why);
}

// The file, unless making it failed.
void finish(base::OutputFile& file, bool good, const std::string& error, MakeOutcome& outcome) {
    outcome.made = good && file.commit();
    if (!outcome.made) {
        outcome.environment = file.error() != 0;
        outcome.error = file.error() != 0
                            ? "cannot write " + file.path() + ": " + std::strerror(file.error())
                            : error;
    }
}

void write_own_map(const std::string& path, const MapFile& map, MakeOutcome& outcome) {
    base::OutputFile file(path);
    std::string error;
    const bool good = write_map_file(map, file, error);
    finish(file, good, error, outcome);
}

void make_picture(const MakeRequest& request, MakeOutcome& outcome) {
    std::string error;
    const perigee_textures* module = texture_module(error);
    if (module == nullptr) {
        outcome.environment = true;
        fail(outcome, "OpenImageIO cannot be had (" + error + ")");
        return;
    }
    const std::string filter = oiio_filter(request.filter, outcome);
    const std::string smode = wrap_mode(request.smode, outcome);
    const std::string tmode = wrap_mode(request.tmode, outcome);
    perigee_make make{};
    make.kind = request.kind == MapKind::LatLong ? "latlong" : "texture";
    make.picture = request.sources.front().c_str();
    make.smode = smode.c_str();
    make.tmode = tmode.c_str();
    make.filter = filter.c_str();
    make.format = request.format.c_str();
    make.compression = request.compression.c_str();
    make.resize = request.resize ? 1 : 0;
    make.mipmap = request.mipmap ? 1 : 0;
    std::array<char, 512> text{};
    base::OutputFile file(request.target);
    const bool good = module->make(&make, take_bytes, &file, text.data(), text.size()) != 0;
    finish(file, good, request.sources.front() + ": " + text.data(), outcome);
}

// Frees what the module allocated.
class Pixels {
public:
    explicit Pixels(const perigee_textures& module) : module_(module) {}
    ~Pixels() { module_.free_pixels(&pixels_); }
    Pixels(const Pixels&) = delete;
    Pixels& operator=(const Pixels&) = delete;
    [[nodiscard]] perigee_pixels* get() { return &pixels_; }
    [[nodiscard]] MapImage image() const {
        MapImage image;
        image.width = pixels_.width;
        image.height = pixels_.height;
        image.num_channels = pixels_.num_channels;
        image.values.assign(pixels_.values,
                            pixels_.values + static_cast<std::size_t>(image.width) *
                                                 static_cast<std::size_t>(image.height) *
                                                 static_cast<std::size_t>(image.num_channels));
        return image;
    }

private:
    const perigee_textures& module_;
    perigee_pixels pixels_{};
};

bool read_faces(const MakeRequest& request, std::array<MapImage, num_cube_faces>& faces,
                MakeOutcome& outcome) {
    std::string error;
    const perigee_textures* module = texture_module(error);
    if (module == nullptr) {
        outcome.environment = true;
        fail(outcome, "OpenImageIO cannot be had (" + error + ")");
        return false;
    }
    for (std::size_t i = 0; i < faces.size(); ++i) {
        Pixels pixels(*module);
        std::array<char, 512> text{};
        const std::string& source = request.sources[i];
        if (module->read(source.c_str(), max_map_values / num_cube_faces, pixels.get(), text.data(),
                         text.size()) == 0) {
            fail(outcome, "cannot read " + source + ": " + text.data());
            return false;
        }
        faces[i] = pixels.image();
        if (faces[i].num_channels != faces[0].num_channels) {
            fail(outcome, source + " has not as many channels as " + request.sources[0]);
            return false;
        }
    }
    return true;
}

void make_cube(const MakeRequest& request, MakeOutcome& outcome) {
    std::array<MapImage, num_cube_faces> faces;
    if (request.sources.size() != faces.size()) {
        fail(outcome, "a cube needs six pictures: px nx py ny pz nz");
        return;
    }
    if (!read_faces(request, faces, outcome)) {
        return;
    }
    MapFile map{std::string(cube_format), {}};
    map.images.push_back(assemble_cube(faces, request.fov_deg));
    write_own_map(request.target, map, outcome);
}

// Depth files, each with the matrices of its camera.
void make_shadow(const MakeRequest& request, MakeOutcome& outcome) {
    MapFile map{std::string(shadow_format), {}};
    for (const std::string& source : request.sources) {
        std::string error;
        std::optional<MapFile> depth = read_map_file(source, error);
        if (!depth) {
            fail(outcome, "cannot read " + source + ": " + error);
            return;
        }
        for (MapImage& image : depth->images) {
            if (!image.has_matrices) {
                fail(outcome, source + " is no depth file: it has no camera matrices");
                return;
            }
            if (image.num_channels > 1) {
                const auto n = static_cast<std::size_t>(image.num_channels);
                for (std::size_t i = 0; i * n < image.values.size(); ++i) {
                    image.values[i] = image.values[i * n];
                }
                image.values.resize(image.values.size() / n);
                image.num_channels = 1;
            }
            map.images.push_back(std::move(image));
        }
    }
    write_own_map(request.target, map, outcome);
}

// Point clouds with the same channels become one.
void make_points(const MakeRequest& request, MakeOutcome& outcome) {
    std::optional<PointCloud> all;
    for (const std::string& source : request.sources) {
        std::string error;
        std::optional<PointCloud> cloud = read_ply(source, error);
        if (!cloud) {
            fail(outcome, "cannot read " + source + ": " + error);
            return;
        }
        if (!all) {
            all = std::move(cloud);
            continue;
        }
        if (cloud->stride != all->stride) {
            fail(outcome, source + " has other channels than " + request.sources.front());
            return;
        }
        all->numbers.insert(all->numbers.end(), cloud->numbers.begin(), cloud->numbers.end());
    }
    const std::string error =
        all ? base::write_file_atomically(request.target, ply_text(*all)) : "no point cloud";
    outcome.made = error.empty();
    outcome.environment = all && !error.empty();
    outcome.error = error;
}

} // namespace

MakeOutcome make_map(const MakeRequest& request) {
    MakeOutcome outcome;
    if (request.sources.empty() || request.target.empty()) {
        outcome.error = "no picture to make it from";
        return outcome;
    }
    switch (request.kind) {
    case MapKind::Texture:
    case MapKind::LatLong:
        make_picture(request, outcome);
        break;
    case MapKind::Cube:
        make_cube(request, outcome);
        break;
    case MapKind::Shadow:
    case MapKind::Occlusion:
        make_shadow(request, outcome);
        break;
    case MapKind::Points:
        make_points(request, outcome);
        break;
    }
    return outcome;
}

} // namespace trace
