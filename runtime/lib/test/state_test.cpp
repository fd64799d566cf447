// SPDX-License-Identifier: Apache-2.0
// Strings, messages, queries, and the rows that later versions bring to life (their fallbacks and
// reports). reference/sl.md 4.5, 4.7, 4.8.
#include "runtime/lib/test/fixture.h"
#include "runtime/lib/test/state_driver.h"
#include "runtime/lib/test_services.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace lanes_test {
namespace {

const Covers covers{"concat",
                    "printf",
                    "format",
                    "match",
                    "raylevel",
                    "isshadowray",
                    "isindirectray",
                    "raylabel",
                    "rayinfo",
                    "message_atmosphere",
                    "message_displacement",
                    "message_lightsource",
                    "message_surface",
                    "message_incident",
                    "message_opposite",
                    "message_attribute",
                    "message_option",
                    "message_rendererinfo",
                    "shadername",
                    "shadername_of",
                    "shadeop_0",
                    "shadeop_1",
                    "shadeop_2",
                    "shadeop_3",
                    "shadeop_4",
                    "shadeop_5",
                    "shadeop_6",
                    "shadeop_7",
                    "shadeop_8",
                    "filterstep",
                    "Du_f",
                    "Du_3",
                    "Dv_f",
                    "Dv_3",
                    "Deriv_f",
                    "Deriv_3",
                    "area",
                    "area_strategy",
                    "calculatenormal",
                    "trace_c",
                    "trace_f",
                    "visibility",
                    "transmission",
                    "rayhittest",
                    "fulltrace",
                    "occlusion",
                    "occlusion_map",
                    "occlusion_map_2",
                    "indirectdiffuse",
                    "indirectdiffuse_map",
                    "caustic",
                    "photonmap",
                    "subsurface",
                    "texture_f",
                    "texture_f_st",
                    "texture_f_quad",
                    "texture_c",
                    "texture_c_st",
                    "texture_c_quad",
                    "environment_f",
                    "environment_f_quad",
                    "environment_c",
                    "environment_c_quad",
                    "shadow_f",
                    "shadow_f_quad",
                    "shadow_c",
                    "shadow_c_quad",
                    "bump",
                    "bump_st",
                    "bump_quad",
                    "textureinfo",
                    "bake_f",
                    "bake_3",
                    "bake3d",
                    "texture3d"};

struct alignas(32) Lanes {
    float v[16 * 8] = {};
};

class State : public testing::Test {
protected:
    State() : engine(8), batch(8, engine) {}

    template <class F> void each_width(F f) {
        std::vector<const state_driver*> all{&state_driver_4};
        if (__builtin_cpu_supports("avx2"))
            all.push_back(&state_driver_8);
        for (const state_driver* d : all)
            for (const bool uniform : {true, false}) {
                driver = d;
                engine.set_lanes(d->lanes);
                engine.printed.clear();
                f(uniform);
            }
    }
    // format() of uniform values
    std::string format(bool uniform, const char* text, std::vector<sl_value> values) {
        sl_string result[8] = {};
        driver->format(&batch.batch(), 1, uniform, text, values.data(),
                       static_cast<int>(values.size()), result);
        return result[0];
    }
    rt::TestEngine engine;
    rt::TestBatch batch;
    const state_driver* driver = nullptr;
};

sl_value value(sl_type type, void* data, int array_length = 0, bool varying = false) {
    return {type, varying, array_length, data};
}

TEST_F(State, FormatDirectives) {
    float x = 3.25f, frame = 7, triple[3] = {1, -2, 0.5f}, list[2] = {4, 5};
    float matrix[16];
    for (int i = 0; i < 16; i++)
        matrix[i] = static_cast<float>(i);
    sl_string s = "wood";
    each_width([&](bool u) {
        EXPECT_EQ(format(u, "x=%f", {value(SL_TYPE_float, &x)}), "x=3.250000");
        EXPECT_EQ(format(u, "%.2f|%8.1f|%-6.1f|%+.0f",
                         {value(SL_TYPE_float, &x), value(SL_TYPE_float, &x),
                          value(SL_TYPE_float, &x), value(SL_TYPE_float, &frame)}),
                  "3.25|     3.2|3.2   |+7");
        EXPECT_EQ(format(u, "tex.%04d.tif", {value(SL_TYPE_float, &frame)}), "tex.0007.tif");
        EXPECT_EQ(format(u, "%d", {value(SL_TYPE_float, &x)}), "3");
        EXPECT_EQ(format(u, "%.2p", {value(SL_TYPE_point, triple)}), "1.00 -2.00 0.50");
        for (const char* d : {"%.1p", "%.1v", "%.1n", "%.1c"})
            EXPECT_EQ(format(u, d, {value(SL_TYPE_color, triple)}), "1.0 -2.0 0.5");
        EXPECT_EQ(format(u, "%.0m", {value(SL_TYPE_matrix, matrix)}),
                  "0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15");
        EXPECT_EQ(format(u, "%s-%5s-%.2s",
                         {value(SL_TYPE_string, &s), value(SL_TYPE_string, &s),
                          value(SL_TYPE_string, &s)}),
                  "wood- wood-wo");
        EXPECT_EQ(format(u, "100%% %", {}), "100% %");
        EXPECT_EQ(format(u, "%q %f", {value(SL_TYPE_float, &frame)}), "%q 7.000000");
        EXPECT_EQ(format(u, "%d %d", {value(SL_TYPE_float, list, 2)}),
                  "4 5 "); // arrays whole; missing: nothing
        EXPECT_EQ(format(u, "%f", {value(SL_TYPE_string, &s)}), "wood"); // the value's type decides
    });
}

TEST_F(State, FormatIsBoundedAndDefined) {
    float huge = 3e38f, nan = std::nanf(""), inf = std::numeric_limits<float>::infinity();
    const std::string line(3000, 'x');
    sl_string s = line.c_str();
    each_width([&](bool u) {
        EXPECT_EQ(format(u, "%d", {value(SL_TYPE_float, &nan)}), "0");
        EXPECT_EQ(format(u, "%d", {value(SL_TYPE_float, &huge)}).substr(0, 3),
                  "920"); // the largest integer kept
        EXPECT_EQ(format(u, "%f", {value(SL_TYPE_float, &inf)}), "inf");
        EXPECT_LE(format(u, "%99999999.99999999f", {value(SL_TYPE_float, &huge)}).size(), 4095u);
        EXPECT_EQ(format(u, "%s%s", {value(SL_TYPE_string, &s), value(SL_TYPE_string, &s)}).size(),
                  4095u);
    });
}

TEST_F(State, PrintfOncePerLivePoint) {
    Lanes x;
    for (int i = 0; i < 8; i++)
        x.v[i] = static_cast<float>(i);
    float same = 5;
    each_width([&](bool uniform) {
        if (uniform)
            return;
        const sl_value varying[] = {value(SL_TYPE_float, x.v, 0, true),
                                    value(SL_TYPE_float, &same)};
        driver->print(&batch.batch(), 0b1010, false, "%.0f %.0f\n", varying, 2);
        EXPECT_EQ(engine.printed,
                  (std::vector<std::string>{"1 5\n", "3 5\n"})); // only active lanes
        engine.printed.clear();
        driver->print(&batch.batch(), 0b1010, false, "hello\n", nullptr, 0);
        EXPECT_EQ(engine.printed, (std::vector<std::string>{"hello\n"})); // nothing varies: once
        engine.printed.clear();
        driver->print(&batch.batch(), 0, false, "hello\n", nullptr, 0);
        EXPECT_TRUE(engine.printed.empty());
        driver->print(&batch.batch(), 1, true, "%.1f", &varying[1], 1);
        EXPECT_EQ(engine.printed, (std::vector<std::string>{"5.0"}));
    });
}

TEST_F(State, FormatPerLane) {
    Lanes x;
    for (int i = 0; i < 8; i++)
        x.v[i] = static_cast<float>(i) / 2;
    each_width([&](bool uniform) {
        if (uniform)
            return;
        sl_string result[8] = {};
        const sl_value v = value(SL_TYPE_float, x.v, 0, true);
        driver->format(&batch.batch(), 0b0110, false, "%.1f", &v, 1, result);
        EXPECT_STREQ(result[1], "0.5");
        EXPECT_STREQ(result[2], "1.0");
        EXPECT_EQ(result[1], engine.text("0.5")); // interned
    });
}

TEST_F(State, Concat) {
    const std::string line(3000, 'x');
    each_width([&](bool u) {
        sl_string result = nullptr;
        const sl_string parts[] = {"a", "", "bc", "d"};
        driver->concat(&batch.batch(), u, parts, 4, &result);
        EXPECT_EQ(result, engine.text("abcd"));
        const sl_string longer[] = {line.c_str(), line.c_str()};
        engine.reports.clear();
        driver->concat(&batch.batch(), u, longer, 2, &result);
        EXPECT_EQ(std::string(result).size(), 4095u);
        EXPECT_EQ(engine.reports.size(), 1u);
    });
}

TEST_F(State, Match) {
    each_width([&](bool u) {
        EXPECT_EQ(driver->match(&batch.batch(), u, "^wood.*[0-9]$", "wood_floor7"), 1);
        EXPECT_EQ(driver->match(&batch.batch(), u, "oo", "wood"), 1); // anywhere
        EXPECT_EQ(driver->match(&batch.batch(), u, "^oo", "wood"), 0);
        EXPECT_EQ(driver->match(&batch.batch(), u, "\\(ab\\)*c", "ababc"), 1);
        EXPECT_EQ(driver->match(&batch.batch(), u, "a+b", "aab"), 0); // basic: + is itself
        EXPECT_EQ(driver->match(&batch.batch(), u, "[", "["), 0);     // not an expression
        EXPECT_EQ(driver->match(&batch.batch(), u, "", "x"), 1);
    });
}

// --- messages

TEST_F(State, MessagesByKind) {
    for (int kind = SL_MESSAGE_lightsource; kind <= SL_MESSAGE_rendererinfo; kind++) {
        engine.messages.clear();
        engine.messages[{kind, "size"}] = {.values = {static_cast<float>(kind) + 0.5f}};
        each_width([&](bool u) {
            Lanes out, result;
            const sl_value v = value(SL_TYPE_float, out.v, 0, !u);
            driver->ask(&batch.batch(), 0b11, u, kind, "size", &v, result.v);
            EXPECT_EQ(result.v[0], 1);
            EXPECT_EQ(out.v[0], static_cast<float>(kind) + 0.5f);
            if (!u) {
                EXPECT_EQ(result.v[2], 0); // not asked
                EXPECT_EQ(out.v[2], 0);
            }
            out.v[0] = 9;
            driver->ask(&batch.batch(), 1, u, kind, "absent", &v, result.v);
            EXPECT_EQ(result.v[0], 0);
            EXPECT_EQ(out.v[0], 9); // failure leaves the variable
            const sl_value wrong = value(SL_TYPE_color, out.v, 0, !u);
            driver->ask(&batch.batch(), 1, u, kind, "size", &wrong, result.v);
            EXPECT_EQ(result.v[0], 0); // another type
        });
    }
}

TEST_F(State, MessagesOfAllShapes) {
    engine.messages[{SL_MESSAGE_option, "Format"}] = {.array_length = 3, .values = {640, 480, 1}};
    engine.messages[{SL_MESSAGE_option, "tint"}] = {.type = SL_TYPE_color, .values = {1, 2, 3}};
    engine.messages[{SL_MESSAGE_option, "pass"}] = {
        .type = SL_TYPE_string, .values = {}, .texts = {"beauty"}};
    engine.messages[{SL_MESSAGE_option, "big"}] = {.array_length = 100,
                                                   .values = std::vector<float>(100, 4)};
    engine.messages[{SL_MESSAGE_surface, "some"}] = {.values = {2}, .answers = 0b0101};
    each_width([&](bool u) {
        const int step = u ? 1 : driver->lanes;
        Lanes out, result;
        sl_value v = value(SL_TYPE_float, out.v, 3, !u);
        driver->ask(&batch.batch(), 1, u, SL_MESSAGE_option, "Format", &v, result.v);
        EXPECT_EQ(out.v[0], 640);
        EXPECT_EQ(out.v[step], 480);
        EXPECT_EQ(out.v[2 * step], 1);
        v = value(SL_TYPE_color, out.v, 0, !u);
        driver->ask(&batch.batch(), 1, u, SL_MESSAGE_option, "tint", &v, result.v);
        EXPECT_EQ(out.v[2 * step], 3);
        alignas(64) sl_string text[8] = {};
        v = value(SL_TYPE_string, text, 0, !u);
        driver->ask(&batch.batch(), 1, u, SL_MESSAGE_option, "pass", &v, result.v);
        EXPECT_STREQ(text[0], "beauty");
        alignas(32) static float big[100 * 8];
        v = value(SL_TYPE_float, big, 100, !u);
        driver->ask(&batch.batch(), 1, u, SL_MESSAGE_option, "big", &v, result.v);
        EXPECT_EQ(big[99 * step], 4);
        if (!u) {
            v = value(SL_TYPE_float, out.v, 0, true);
            driver->ask(&batch.batch(), 0b1111, false, SL_MESSAGE_surface, "some", &v, result.v);
            EXPECT_EQ(result.v[0], 1);
            EXPECT_EQ(result.v[1], 0);
            EXPECT_EQ(result.v[2], 1);
            v = value(SL_TYPE_float, out.v, 0, false); // a uniform variable asked from varying code
            out.v[0] = 0;
            driver->ask(&batch.batch(), 0b0100, false, SL_MESSAGE_surface, "some", &v, result.v);
            EXPECT_EQ(out.v[0], 2);
        }
    });
}

TEST_F(State, RayQueries) {
    batch.set_triple(SL_VAR_I, 0, {0, 3, 4});
    batch.set_triple(SL_VAR_P, 0, {1, 1, 1});
    engine.ray_level = 2;
    engine.ray_type = SL_RAY_reflection;
    each_width([&](bool u) {
        const int step = u ? 1 : driver->lanes;
        Lanes out, result;
        const auto ask = [&](const char* key, sl_type type) {
            const sl_value v = value(type, out.v, 0, !u);
            driver->ask(&batch.batch(), 1, u, DRIVER_rayinfo, key, &v, result.v);
            return result.v[0] == 1;
        };
        EXPECT_TRUE(ask("depth", SL_TYPE_float));
        EXPECT_EQ(out.v[0], 2);
        EXPECT_TRUE(ask("speculardepth", SL_TYPE_float));
        EXPECT_EQ(out.v[0], 2);
        EXPECT_TRUE(ask("diffusedepth", SL_TYPE_float));
        EXPECT_EQ(out.v[0], 0);
        EXPECT_TRUE(ask("shadowdepth", SL_TYPE_float));
        EXPECT_TRUE(ask("length", SL_TYPE_float));
        EXPECT_EQ(out.v[0], 5);
        EXPECT_TRUE(ask("origin", SL_TYPE_point));
        EXPECT_EQ(out.v[step], -2);
        EXPECT_TRUE(ask("direction", SL_TYPE_vector));
        EXPECT_NEAR(out.v[step], 0.6, 1e-7);
        EXPECT_FALSE(ask("direction", SL_TYPE_float));
        EXPECT_FALSE(ask("unheard of", SL_TYPE_float));
        alignas(64) sl_string text[8] = {};
        sl_value v = value(SL_TYPE_string, text, 0, !u);
        driver->ask(&batch.batch(), 1, u, DRIVER_rayinfo, "type", &v, result.v);
        EXPECT_STREQ(text[0], "specular");
        driver->ask(&batch.batch(), 1, u, DRIVER_rayinfo, "label", &v, result.v);
        EXPECT_STREQ(text[0], "");
        EXPECT_STREQ(driver->ray_label(&batch.batch(), u), "");
    });
    EXPECT_EQ(run_all("raylevel", {}, 8, &batch.batch())[0][5], 2);
    EXPECT_EQ(run_all("isshadowray", {}, 8, &batch.batch())[0][0], 0);
    engine.ray_type = SL_RAY_shadow;
    EXPECT_EQ(run_all("isshadowray", {}, 8, &batch.batch())[0][0], 1);
    EXPECT_EQ(run_all("isindirectray", {}, 8, &batch.batch())[0][0], 0);
    engine.ray_type = SL_RAY_diffuse;
    EXPECT_EQ(run_all("isindirectray", {}, 8, &batch.batch())[0][0], 1);
}

TEST_F(State, ShaderNames) {
    engine.shader_names = {{"", "marble"}, {"displacement", "dents"}};
    each_width([&](bool u) {
        EXPECT_STREQ(driver->shader_name(&batch.batch(), u, nullptr), "marble");
        EXPECT_STREQ(driver->shader_name(&batch.batch(), u, "displacement"), "dents");
        EXPECT_STREQ(driver->shader_name(&batch.batch(), u, "atmosphere"), "");
    });
}

// --- rows of later versions

struct Fallback {
    const char* case_name;
    float value; // of every result component
    int reports;
};

TEST_F(State, LaterRowsFallBackAndReportOnce) {
    const Fallback rows[] = {{"filterstep", 1, 1},
                             {"Du_f", 0, 1},
                             {"Du_3", 0, 1},
                             {"Dv_f", 0, 1},
                             {"Dv_3", 0, 1},
                             {"Deriv_f", 0, 1},
                             {"Deriv_3", 0, 1},
                             {"area", 0, 1},
                             {"area_strategy", 0, 1},
                             {"trace_c", 0, 0},
                             {"trace_f", 1e30f, 0},
                             {"visibility", 1, 0},
                             {"transmission", 1, 0},
                             {"rayhittest", 1e30f, 0},
                             {"occlusion", 0, 0},
                             {"occlusion_map", 0, 1},
                             {"occlusion_map_2", 0, 1},
                             {"indirectdiffuse", 0, 0},
                             {"indirectdiffuse_map", 0, 1},
                             {"caustic", 0, 1},
                             {"photonmap", 0, 1},
                             {"subsurface", 0, 1},
                             {"texture_f", 0, 0},
                             {"texture_f_fill", 0.25f, 1},
                             {"texture_f_st", 0, 0},
                             {"texture_f_quad", 0, 0},
                             {"texture_c", 1, 0},
                             {"texture_c_fill", 0.25f, 1},
                             {"texture_c_st", 1, 0},
                             {"texture_c_quad", 1, 0},
                             {"environment_f", 0, 0},
                             {"environment_f_quad", 0, 0},
                             {"environment_c", 0, 0},
                             {"environment_c_quad", 0, 0},
                             {"shadow_f", 0, 0},
                             {"shadow_f_named", 0, 1},
                             {"shadow_f_quad", 0, 0},
                             {"shadow_c", 0, 0},
                             {"shadow_c_quad", 0, 0},
                             {"bump", 2, 1},
                             {"bump_st", 2, 1},
                             {"bump_quad", 2, 1},
                             {"bake_f", 0, 1},
                             {"bake_3", 0, 1},
                             {"bake3d", 0, 1},
                             {"texture3d", 0, 1},
                             {"textureinfo", 5, 1}};
    for (const Fallback& row : rows) {
        engine.reports.clear();
        int num_in = 0;
        for (int i = 0; i < lanes_api_4.num_cases; i++)
            if (std::string(lanes_api_4.cases[i].name) == row.case_name)
                num_in = lanes_api_4.cases[i].num_in;
        const Planes in(static_cast<std::size_t>(num_in), std::vector<float>(8, 2.0f));
        for (const auto& plane : run_all(row.case_name, in, 8, &batch.batch()))
            for (const float v : plane)
                EXPECT_EQ(v, row.value) << row.case_name;
        EXPECT_EQ(engine.reports.size(), static_cast<std::size_t>(row.reports)) << row.case_name;
    }
}

TEST_F(State, AMissingRayMisses) {
    engine.trace = [](sl_ray_query& query) {
        for (std::uint32_t i = 0; i < 3 * query.lanes; ++i) {
            query.Pmiss[i] = query.P[i];
            query.Rmiss[i] = query.D[i];
        }
        for (std::uint32_t i = 0; i < query.lanes; ++i) {
            query.level_missed[i] = 2;
        }
    };
    const Planes in = {{1}, {2}, {3}, {4}, {5}, {6}};
    const Planes got = run_all("fulltrace", in, 1, &batch.batch());
    EXPECT_EQ(got[0][0], 2); // the depth of the ray that missed
    EXPECT_EQ(got[1][0], 1e30f);
    EXPECT_EQ(got[5][0], 1);
    EXPECT_EQ(got[10][0], 6);
    each_width([&](bool) { EXPECT_EQ(driver->outputs_respect_mask(&batch.batch()), 1); });
}

TEST_F(State, CalculateNormalFacesWithNg) {
    for (std::uint32_t i = 0; i < 8; i++) {
        batch.set_triple(SL_VAR_N, i, {0, 0, i % 2 ? 1.0f : -1.0f});
        batch.set_triple(SL_VAR_Ng, i, {0, 0.5f, 1});
    }
    for (const float z :
         run_plane(2, "calculatenormal", Planes(3, std::vector<float>(8)), 8, &batch.batch()))
        EXPECT_EQ(z, 1);
}

} // namespace
} // namespace lanes_test
