// SPDX-License-Identifier: Apache-2.0
#include "tracer/indirect_frame.h"

#include "tracer/irradiance_file.h"

#include <cmath>
#include <string>

namespace trace {

namespace {

std::string file_of(const rib::Options& options, const char* name, base::SourcePos& pos) {
    const auto it = options.user.find(name);
    if (it == options.user.end() || it->second.strings.empty()) {
        return "";
    }
    pos = it->second.pos;
    return it->second.strings.front();
}

void seed(IndirectLight& light, const FrameContext& frame) {
    base::SourcePos pos;
    const std::string path = file_of(frame.scene.options, "indirect:seedfile", pos);
    if (path.empty()) {
        return;
    }
    const IrradianceFile file = read_irradiance(path);
    if (!file.error.empty()) {
        frame.diag.report(base::Severity::Warning, base::Code::BadFile, pos,
                          "Option \"indirect\" \"seedfile\": " + path + " " + file.error +
                              "; rendering begins without records");
    }
    const base::Mat4& camera_from_world = frame.spaces.camera_from_world();
    const auto world_from_camera = base::inverse(camera_from_world);
    for (const IrradianceRecord& record : file.records) {
        if (world_from_camera) {
            light.cache.insert(transformed(record, camera_from_world, *world_from_camera));
        }
    }
}

void save(const IndirectLight& light, const FrameContext& frame) {
    base::SourcePos pos;
    const std::string path = file_of(frame.scene.options, "indirect:savefile", pos);
    const base::Mat4& camera_from_world = frame.spaces.camera_from_world();
    const auto world_from_camera = base::inverse(camera_from_world);
    if (path.empty() || !world_from_camera) {
        return;
    }
    std::vector<IrradianceRecord> records;
    records.reserve(light.cache.records().size());
    for (const IrradianceRecord& record : light.cache.records()) {
        records.push_back(transformed(record, *world_from_camera, camera_from_world));
    }
    const std::string error = write_irradiance(path, records);
    if (!error.empty()) {
        frame.diag.report(base::Severity::Severe, base::Code::System, pos,
                          "Option \"indirect\" \"savefile\": " + error);
    }
}

} // namespace

// Gradients are changes per length and per turn; turns change their sense in a mirror.
IrradianceRecord transformed(const IrradianceRecord& record, const base::Mat4& to_from,
                             const base::Mat4& from_to) {
    const double volume = base::determinant3(to_from);
    const double scale = std::cbrt(std::fabs(volume));
    const double sense = volume < 0 ? -1 : 1;
    const auto turned = [&](const base::V3f& v, double factor) {
        return base::V3f(factor / scale * base::vector(to_from, base::V3d(v)));
    };
    IrradianceRecord out = record;
    out.P = base::V3f(base::point(to_from, base::V3d(record.P)));
    out.N = base::V3f(base::normalize(base::normal_by_inverse(from_to, base::V3d(record.N))));
    for (std::size_t k = 0; k < 3; ++k) {
        out.rotation[k] = turned(record.rotation[k], sense);
        out.translation[k] = turned(record.translation[k], 1 / scale);
    }
    out.radius = static_cast<float>(static_cast<double>(record.radius) * scale);
    return out;
}

bool prepare_indirect(IndirectLight& light, const IndirectPrepass::Tools& tools,
                      Counters& counted) {
    if (!light.interpolates()) {
        return true;
    }
    seed(light, tools.frame);
    IndirectPrepass prepass(tools, light);
    const bool is_done = prepass.run();
    counted += prepass.counters();
    if (is_done) {
        save(light, tools.frame);
    }
    return is_done;
}

} // namespace trace
