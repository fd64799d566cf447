// SPDX-License-Identifier: Apache-2.0
#include "slc/emit_runner.h"

#include "runtime/base/file.h"

#include <cstring>

namespace slc {

namespace {

std::int32_t no_lights(void*) {
    return 0;
}
std::uint32_t no_light(void*, const sl_light_query*, sl_light_result*) {
    return 0;
}
void no_ambient(void*, std::uint32_t, std::uint32_t, const float*, float*) {}
std::int32_t identity_space(void*, sl_string, sl_string, std::uint32_t, float* m) {
    for (int i = 0; i < 16; ++i) {
        m[i] = i % 5 == 0 ? 1.0F : 0.0F;
    }
    return 1;
}
std::uint32_t no_message(void*, std::int32_t, sl_string, std::int32_t, std::int32_t, std::uint32_t,
                         std::uint32_t, float*) {
    return 0;
}
void no_print(void*, std::uint32_t, sl_string) {}
sl_string no_intern(void*, const char*) {
    return "";
}
sl_string no_name(void*, sl_string) {
    return "";
}
void no_report(void*, std::int32_t, const char*) {}
std::uint32_t no_more_steps(void*, std::uint32_t, std::uint32_t, sl_string, std::int32_t) {
    return 0;
}
void no_complaint(void*, std::uint32_t, std::uint32_t, sl_string, std::int32_t, const char*) {}
void unit_depth(void*, float* near_far) {
    near_far[0] = 0;
    near_far[1] = 1;
}
std::uint32_t no_light_message(void*, const sl_light_query*, sl_string, std::int32_t, std::int32_t,
                               float*) {
    return 0;
}
std::int32_t no_match(void*, sl_string, sl_string) {
    return 0;
}
void no_shadeop(void*, sl_string, std::uint32_t, std::uint32_t, const sl_value*, std::int32_t,
                const sl_value*, std::int32_t) {}
void no_rays(void*, sl_ray_query* query) {
    query->hit = 0;
}
void plain_direction(void*, std::uint32_t, std::uint32_t, const float*, const float*, float*) {}
std::int32_t zero(void*) {
    return 0;
}

} // namespace

sl_services empty_services(rt::StringTable&) {
    sl_services s{};
    s.light_count = no_lights;
    s.light = no_light;
    s.ambient = no_ambient;
    s.space = identity_space;
    s.message = no_message;
    s.print = no_print;
    s.print_uniform = no_print;
    s.intern = no_intern;
    s.shader_name = no_name;
    s.report = no_report;
    s.loop_steps = no_more_steps;
    s.not_a_number = no_complaint;
    s.depth_range = unit_depth;
    s.raylevel = zero;
    s.ray_kind = zero;
    s.light_message = no_light_message;
    s.match = no_match;
    s.shadeop = no_shadeop;
    s.rays = no_rays;
    s.solar_direction = plain_direction;
    return s;
}

std::vector<BuildWay> all_ways() {
    std::vector<BuildWay> ways = {{4, 2}, {4, 0}};
    if (native_lanes() == 8) {
        ways.push_back({8, 2});
        ways.push_back({8, 0});
    }
    return ways;
}

const rt::ShaderObject* EmitRunner::build(const Program& program, const Facts& facts,
                                          BuildWay way) {
    const auto tools = find_toolchain("", diag);
    if (!tools) {
        return nullptr;
    }
    EmitOptions options;
    options.lanes = way.lanes;
    options.variants = {way.lanes};
    options.source = "test.sl";
    last_c = emit_c(program, facts, options);
    CompileFlags flags;
    flags.optimisation = way.optimisation;
    const std::string path = dir_.path() + "/" + std::to_string(++num_objects_) + ".slo";
    const auto bytes =
        build_shared_object(*tools, {{way.lanes, last_c}}, flags, program.name, {}, diag);
    if (!bytes || !base::write_file_atomically(path, *bytes).empty()) {
        return nullptr;
    }
    return library.load(path, {});
}

} // namespace slc
