// SPDX-License-Identifier: Apache-2.0
// What the graphics state hands finished work to. A renderer registers one; tests register their
// own.
#pragma once

#include "ribtools/scene.h"

#include <cstdint>
#include <memory>

namespace rib {

struct TextureRequest {             // MakeTexture and its relatives
    std::string kind;               // request name
    std::vector<std::string> files; // sources, then the destination
    std::vector<std::string> strings;
    std::vector<float> floats;
    ParamList params;
    Options options;
    base::SourcePos pos;
};

enum class ShaderRole : std::uint8_t {
    Surface,
    Displacement,
    Atmosphere,
    Interior,
    Exterior,
    Light,
    Imager
};

class Backend {
public:
    virtual ~Backend() = default;
    // A request of a wanted world, or of its options, names a shader: time to look for it, long
    // before the world is complete. It may still turn out that nothing uses it. Comes once for
    // equal calls.
    virtual void shader_named(const ShaderCall&, ShaderRole) {}
    // A world is complete. False asks the reader to stop (interrupted, out of disk ...).
    virtual bool render(std::unique_ptr<Scene> scene) = 0;
    // Runs at once. False: not made, and the backend has said why; reading goes on.
    virtual bool make_texture(const TextureRequest& request) = 0;
};

} // namespace rib
