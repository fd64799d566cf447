// SPDX-License-Identifier: Apache-2.0
// Display type "shadow": the depth of a picture as a shadow map (map_file.h), what MakeShadow would
// make of its zfile.
#include "tracer/display_format.h"
#include "tracer/map_file.h"

#include <algorithm>

namespace trace {

namespace {

void put(const base::Mat4& m, float* out) {
    for (int i = 0; i < 16; ++i) {
        out[i] = static_cast<float>(m.m[i / 4][i % 4]);
    }
}

} // namespace

WriteOutcome write_shadow_map(const FilePicture& picture, base::OutputFile& file) {
    MapFile map{std::string(shadow_format), {}};
    MapImage image;
    image.width = picture.width();
    image.height = picture.height();
    image.has_matrices = true;
    put(picture.info.camera_from_world, image.camera_from_world);
    put(screen_from_world(picture.info), image.screen_from_world);
    const std::span<const float> values = picture.find(ChannelRole::Depth)->values;
    image.values.resize(values.size());
    std::ranges::transform(values, image.values.begin(),
                           [](float z) { return std::min(z, rib::ri_infinity); });
    map.images.push_back(std::move(image));
    WriteOutcome outcome;
    outcome.ok = write_map_file(map, file, outcome.error);
    return outcome;
}

} // namespace trace
