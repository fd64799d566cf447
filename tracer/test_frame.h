// SPDX-License-Identifier: Apache-2.0
// For tests: a scene of sheets (test_world.h) put together by hand and rendered by the code that
// renders pictures: 16 x 16 pixels, one sample at each centre, an orthographic view of the square
// -1..1 along +z.
#pragma once

#include "runtime/base/parallel.h"
#include "tracer/bad_values.h"
#include "tracer/bucket.h"
#include "tracer/filter.h"
#include "tracer/imager.h"
#include "tracer/lights.h"
#include "tracer/shader_set.h"
#include "tracer/test_world.h"

#include <array>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace trace::test {

class TestFrame {
public:
    static constexpr int size_px = 16;

    TestFrame() {
        adopt_test_shaders(library);
        adopt_test_ray_shaders(library);
        scene.transforms.emplace_back();
        scene.options.xres = scene.options.yres = size_px;
        scene.options.xsamples = scene.options.ysamples = 1;
        scene.options.filter = "box";
        scene.options.filter_width[0] = scene.options.filter_width[1] = 1;
        scene.options.has_screen_window = true;
        scene.options.screen_window = {-1, 1, -1, 1};
        scene.options.hider_params.params.push_back(
            integer("jitter", 0)); // samples at pixel centres
    }

    static rib::Param integer(const char* name, int value) {
        rib::Param param;
        param.name = name;
        param.decl.type = rib::ParamType::Integer;
        param.ints = {value};
        return param;
    }
    static rib::Param floats(const char* name, rib::ParamType type, std::vector<float> values,
                             rib::StorageClass storage = rib::StorageClass::Uniform) {
        rib::Param param;
        param.name = name;
        param.decl = {storage, type, 1, false};
        param.floats = std::move(values);
        return param;
    }
    static rib::Param text(const char* name, const char* value) {
        rib::Param param;
        param.name = name;
        param.decl.type = rib::ParamType::String;
        param.strings = {value};
        return param;
    }
    static std::array<float, 3> grey(float value) { return {value, value, value}; }
    static rib::Param number(const char* name, float value) {
        return floats(name, rib::ParamType::Float, {value});
    }

    rib::ShaderId shader(const char* name, std::vector<rib::Param> params = {},
                         const base::Mat4& world_from_shader = {}) {
        rib::ShaderCall call;
        call.name = name;
        call.params.params = std::move(params);
        scene.transforms.push_back({{{0, world_from_shader}}});
        call.world_from_shader = static_cast<rib::TransformId>(scene.transforms.size() - 1);
        scene.shaders.push_back(call);
        return static_cast<rib::ShaderId>(scene.shaders.size() - 1);
    }
    rib::LightId light(rib::ShaderId id, std::uint32_t attributes = rib::none) {
        rib::Light light;
        light.shader = id;
        light.attributes = attributes;
        scene.lights.push_back(light);
        return static_cast<rib::LightId>(scene.lights.size() - 1);
    }
    // Adds an attribute state and a sheet that has it, whose Ng points along side z.
    rib::Attributes& sheet(float z, rib::ShaderId surface, float side = -1) {
        rib::Attributes attributes;
        attributes.surface = surface;
        scene.attributes.push_back(attributes);
        Sheet s;
        s.z = z;
        s.side = side;
        s.attributes = static_cast<std::uint32_t>(scene.attributes.size() - 1);
        sheets.push_back(s);
        scene.primitives.emplace_back();
        scene.primitives.back().attributes = s.attributes;
        return scene.attributes.back();
    }
    rib::Attributes& lit_sheet(float z, rib::ShaderId surface, std::vector<rib::LightId> lights) {
        rib::Attributes& attributes = sheet(z, surface);
        attributes.lights = std::move(lights);
        return attributes;
    }
    void option(const char* key, rib::Param param) { scene.options.user[key] = std::move(param); }

    Image render(int num_threads = 1, int bucket_px = size_px) {
        const Camera camera(scene, diag);
        const Spaces spaces(scene, {camera.screen_from_camera(), camera.ndc_from_screen(),
                                    camera.raster_from_screen()});
        const ShaderSet shaders({scene, spaces, library, strings, diag});
        const LightSet lights(scene, shaders);
        const ShadingClasses classes(scene, shaders, lights);
        const SheetWorld world(scene, sheets);
        const FrameContext frame{scene, spaces, strings, diag, &world, &shaders, &lights};
        const Sampler sampler(sampler_settings(scene.options, diag));
        const Filter filter(scene.options.filter, scene.options.filter_width[0],
                            scene.options.filter_width[1], diag);
        const FilterWeights weights(filter, sampler);
        const auto film =
            Film::create(camera.raster(), sampler, weights, {bucket_px, bucket_px}, diag);
        std::vector<std::unique_ptr<BucketRenderer>> renderers(
            static_cast<std::size_t>(num_threads));
        counters = {};
        base::parallel_for(film->num_buckets(), num_threads, [&](std::size_t bucket, int slot) {
            auto& renderer = renderers[static_cast<std::size_t>(slot)];
            if (!renderer) {
                renderer = std::make_unique<BucketRenderer>(
                    frame, camera, sampler, classes, nullptr, visibility_options(scene.options));
            }
            return renderer->render(bucket, *film);
        });
        BadValues bad;
        for (const auto& renderer : renderers) {
            if (renderer) {
                counters += renderer->thread().counters;
                bad.add(renderer->thread().bad);
            }
            report_bad_values(frame, bad, {});
        }
        if (const ShaderEntry* imager = shaders.get(scene.options.imager)) {
            run_imager(frame, *imager, film->image(), num_threads, counters);
        }
        return std::move(film->image());
    }

    // Camera x, y of a pixel's centre.
    static float x_of(std::size_t pixel) {
        return (static_cast<float>(pixel % size_px) + 0.5f) / 8 - 1;
    }
    static float y_of(std::size_t pixel) {
        return 1 - (static_cast<float>(pixel / size_px) + 0.5f) / 8;
    }

    rib::Scene scene;
    std::vector<Sheet> sheets;
    base::Diag diag{std::tmpfile()};
    rt::StringTable strings;
    rt::ShaderLibrary library{{}, strings, diag};
    Counters counters;
};

} // namespace trace::test
