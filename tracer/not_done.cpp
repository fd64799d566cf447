// SPDX-License-Identifier: Apache-2.0
#include "tracer/not_done.h"

#include <string>

namespace trace {

namespace {

class Reporter {
public:
    Reporter(const rib::Scene& scene, base::Diag& diag) : scene_(scene), diag_(diag) {}

    void shader(const char* request, rib::ShaderId id, const char* consequence) {
        if (id >= scene_.shaders.size()) {
            return;
        }
        const rib::ShaderCall& call = scene_.shaders[id];
        if (!call.name.empty() && call.name != "null") {
            once(request, call.pos,
                 std::string(request) + " \"" + call.name + "\": " + consequence);
        }
    }

    void attributes(const rib::Attributes& a) { displacement(a); }

    // Without these attributes BMRT bumps normals only, too.
    void displacement(const rib::Attributes& a) {
        const rib::Param* moves = a.find("render:truedisplacement");
        const rib::Param* bound = a.find("displacementbound:sphere");
        const auto is_set = [](const rib::Param* p) {
            return p != nullptr && ((!p->floats.empty() && p->floats[0] != 0) ||
                                    (!p->ints.empty() && p->ints[0] != 0));
        };
        if (is_set(moves) || is_set(bound)) {
            shader("Displacement", a.displacement,
                   "the surface is shaded as displaced; its outline and shadows stay where they "
                   "are in this version");
        }
    }

    void options(const rib::Options& o) {
        if (o.hider != "hidden" && o.hider != "null") {
            once("Hider", {}, "Hider \"" + o.hider + "\": rendered as \"hidden\" by this version");
        }
        if (scene_.camera_from_world.moving() && o.shutter_close > o.shutter_open) {
            once("camera motion", {},
                 "MotionBegin: a moving camera stands where it is when the shutter opens in this "
                 "version");
        }
    }

private:
    const rib::Scene& scene_;
    base::Diag& diag_;

    void once(const char* key, base::SourcePos pos, const std::string& text) {
        diag_.report_once(std::string("not done:") + key, base::Severity::Warning,
                          base::Code::Unimplement, pos, text);
    }
};

} // namespace

void report_not_done(const rib::Scene& scene, base::Diag& diag) {
    Reporter reporter(scene, diag);
    reporter.options(scene.options);
    for (const rib::Attributes& attributes : scene.attributes) {
        reporter.attributes(attributes);
    }
}

} // namespace trace
