// SPDX-License-Identifier: Apache-2.0
// Maps that are Perigee's own: shadow maps against integrals, cube faces without seams, point
// clouds, and files of all of them, damaged ones included.
#include "runtime/base/file.h"
#include "runtime/base/temp_dir.h"
#include "tracer/cube_map.h"
#include "tracer/environment_light.h"
#include "tracer/map_file.h"
#include "tracer/point_cloud.h"
#include "tracer/shadow_map.h"

#include <array>
#include <cmath>
#include <cstring>
#include <gtest/gtest.h>
#include <string>

namespace {

using base::V3d;

// --- shadow maps

// A light at the origin that looks along z with a field of view of 90 degrees; depth by texel.
template <class Depth> trace::MapImage depth_image(int size, const Depth& depth) {
    trace::MapImage image;
    image.width = image.height = size;
    image.has_matrices = true;
    for (int i = 0; i < 16; i += 5) {
        image.camera_from_world[i] = 1;
    }
    // x' = x, y' = y, z' = z - 1, w = z
    const float screen[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, -1, 0};
    std::copy_n(screen, 16, image.screen_from_world);
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            image.values.push_back(depth(x, y));
        }
    }
    return image;
}

constexpr V3d none{0, 0, 0};

// Something at depth 1 covers the left half of what the light sees.
trace::ShadowMap half_covered(int size) {
    return trace::ShadowMap(
        depth_image(size, [&](int x, int) { return x < size / 2 ? 1.0f : 1e38f; }));
}

TEST(ShadowMap, LitDarkBehindAndOutside) {
    const trace::ShadowMap map = half_covered(64);
    const auto view = map.view({});
    const trace::ShadowOptions options;
    EXPECT_EQ(map.shadow(view, {-1, 0, 4}, none, none, options), 1);
    EXPECT_EQ(map.shadow(view, {1, 0, 4}, none, none, options), 0);
    EXPECT_EQ(map.shadow(view, {-.25, 0, .5}, none, none, options), 0) << "in front of it";
    EXPECT_EQ(map.shadow(view, {-1, 0, -4}, none, none, options), 0) << "behind the light";
    EXPECT_EQ(map.shadow(view, {-9, 0, 4}, none, none, options), 0) << "outside the map";
    EXPECT_EQ(map.shadow(view, {NAN, 0, 4}, none, none, options), 0);
}

// The share of a box around the edge, which is known.
TEST(ShadowMap, BlurIsTheIntegralOfTheBox) {
    const trace::ShadowMap map = half_covered(256);
    const auto view = map.view({});
    trace::ShadowOptions options;
    options.blur[0] = options.blur[1] = 0.25;
    options.samples = 1024;
    for (const double x : {-.9, -.5, -.2, 0., .1, .3, .6}) {
        const double s = 0.5 + 0.5 * x / 4; // where it lies on the map
        const double width = 0.25 + 1.0 / 256;
        const double expected = std::clamp((0.5 - (s - width / 2)) / width, 0.0, 1.0);
        // 32 strata across: the edge falls into one of them.
        EXPECT_NEAR(map.shadow(view, {x, .3, 4}, none, none, options), expected, 1.0 / 32) << x;
    }
}

TEST(ShadowMap, FootprintCountsAsBlurDoes) {
    const trace::ShadowMap map = half_covered(256);
    const auto view = map.view({});
    trace::ShadowOptions options;
    options.samples = 1024;
    // One unit across at depth 4 is an eighth of the map.
    const double got = map.shadow(view, {.125, 0, 4}, {1, 0, 0}, {0, 1, 0}, options);
    EXPECT_NEAR(got, 0.375, 1.0 / 32);
    options.width[0] = 0;
    EXPECT_EQ(map.shadow(view, {.125, 0, 4}, {1, 0, 0}, {0, 1, 0}, options), 0);
}

TEST(ShadowMap, TexelsAreBlendedWhereTheyAreLarge) {
    const trace::ShadowMap map = half_covered(8);
    const auto view = map.view({});
    for (const double offset : {-.4, -.1, 0., .3}) { // of a texel, from the edge
        const double x = offset * 2 / 8 * 4;
        EXPECT_NEAR(map.shadow(view, {x, 0.5, 4}, none, none, {}), 0.5 - offset, 1e-9);
    }
}

// A tilted plane must not shadow itself, whatever the blur, without a bias.
TEST(ShadowMap, APlaneDoesNotShadowItself) {
    constexpr int size = 128;
    constexpr double tilt = 3;                        // z = 6 + 3 x
    const auto plane_depth = [](double s, double t) { // the ray (s, t, 1) d: d = 6 + 3 s d
        (void)t;
        return 6 / (1 - tilt * s);
    };
    const trace::ShadowMap map(depth_image(size, [&](int x, int y) {
        // somewhere in the texel, as a renderer's samples lie
        const double a = 0.5 + 0.45 * std::sin(x * 12.9 + y * 78.2);
        const double s = 2 * (x + a) / size - 1;
        const double z = plane_depth(s, y);
        return z > 0 ? static_cast<float>(z) : 1e38f;
    }));
    const auto view = map.view({});
    trace::ShadowOptions options;
    for (const double blur : {0.0, 0.02, 0.1}) {
        options.blur[0] = options.blur[1] = blur;
        for (double x = -1.2; x < 1.5; x += 0.037) {
            const V3d P{x, 0.21, 6 + tilt * x};
            const V3d P_u{0.01, 0, 0.01 * tilt}, P_v{0, 0.01, 0};
            EXPECT_EQ(map.shadow(view, P, P_u, P_v, options), 0) << x << " blur " << blur;
            const V3d behind{P.x * 1.2, P.y * 1.2, P.z * 1.2};
            EXPECT_NEAR(map.shadow(view, behind, P_u, P_v, options), 1, 1e-9)
                << x << " blur " << blur;
        }
    }
}

TEST(ShadowMap, BiasMovesTheComparison) {
    const trace::ShadowMap map(depth_image(16, [](int, int) { return 4.0f; }));
    const auto view = map.view({});
    trace::ShadowOptions options;
    options.has_bias = true;
    EXPECT_EQ(map.shadow(view, {0.1, 0.1, 4.5}, none, none, options), 1);
    options.bias[0] = options.bias[1] = 0.6;
    EXPECT_EQ(map.shadow(view, {0.1, 0.1, 4.5}, none, none, options), 0);
    options.bias[0] = 0;
    options.bias[1] = 1;
    options.blur[0] = options.blur[1] = 0.3;
    options.samples = 400;
    // Half of the biases are less than the distance of .5.
    EXPECT_NEAR(map.shadow(view, {0.1, 0.1, 4.5}, none, none, options), 0.5, 0.08);
}

TEST(ShadowMap, ParallelLight) {
    trace::MapImage image = depth_image(32, [](int x, int) { return x < 16 ? 1.0f : 1e38f; });
    const float screen[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, .1f, 0, 0, 0, 0, 1};
    std::copy_n(screen, 16, image.screen_from_world);
    const trace::ShadowMap map(image);
    const auto view = map.view({});
    EXPECT_EQ(map.shadow(view, {-.5, 0, 5}, none, none, {}), 1);
    EXPECT_EQ(map.shadow(view, {.5, 0, 5}, none, none, {}), 0);
    EXPECT_NEAR(map.to_light(view, {3, 1, 5}).z, -1, 1e-12);
}

// --- cubes

// Every face shows a smooth function of the direction.
template <class F> trace::MapImage cube_of(int n, int channels, const F& f) {
    trace::MapImage image;
    image.width = 3 * n;
    image.height = 2 * n;
    image.num_channels = channels;
    image.values.resize(static_cast<std::size_t>(6 * n * n * channels));
    for (int face = 0; face < trace::num_cube_faces; ++face) {
        const trace::CubeFace& c = trace::cube_face(face);
        const trace::CubeCell cell = trace::cube_cell(face);
        for (int y = 0; y < n; ++y) {
            for (int x = 0; x < n; ++x) {
                const V3d d = base::normalize(c.forward + ((2 * x + 1.0) / n - 1) * c.right +
                                              (1 - (2 * y + 1.0) / n) * c.up);
                for (int k = 0; k < channels; ++k) {
                    image.values[static_cast<std::size_t>(
                        ((cell.row * n + y) * 3 * n + cell.column * n + x) * channels + k)] =
                        static_cast<float>(f(d, k));
                }
            }
        }
    }
    return image;
}

V3d spread_direction(int i) { // a Fibonacci spiral
    const double z = 1 - (2 * i + 1) / 2000.0, a = i * 2.399963229728653;
    const double r = std::sqrt(1 - z * z);
    return {r * std::cos(a), r * std::sin(a), z};
}

TEST(CubeMap, DirectionsFindTheirFaces) {
    const trace::CubeMap map(cube_of(32, 3, [](const V3d& d, int k) { return d[k]; }));
    for (int i = 0; i < 2000; ++i) {
        const V3d d = spread_direction(i);
        float out[3];
        map.lookup(7.0 * d, {}, 0, out);
        for (int k = 0; k < 3; ++k) {
            // Along edges the nearest texel of the neighbour may lie half a texel of 1/16 aside.
            ASSERT_NEAR(static_cast<double>(out[k]), d[k], 1e-2) << d.x << " " << d.y << " " << d.z;
        }
    }
}

// Along a circle through four faces and along one through corners neighbouring lookups never jump.
TEST(CubeMap, NoSeams) {
    const trace::CubeMap map(
        cube_of(8, 1, [](const V3d& d, int) { return 0.5 + 0.5 * std::sin(5 * d.x + 3 * d.y); }));
    for (const double width : {0.0, 0.2, 0.8}) {
        for (const double height : {0.0, 1.0}) {
            float last = 0;
            for (int i = 0; i <= 4000; ++i) {
                const double a = i * 3.14159265358979 / 2000;
                const V3d R{std::cos(a), std::sin(a), height * std::abs(std::cos(a))};
                const V3d u{-width * std::sin(a), width * std::cos(a), 0}, v{0, 0, width};
                float now;
                map.lookup(R, {u, v, 0}, 0, {&now, 1});
                // The function changes by at most 6 per radian, a step is 0.0016.
                ASSERT_TRUE(i == 0 || std::abs(now - last) < 0.03f) << i << " width " << width;
                last = now;
            }
        }
    }
}

TEST(CubeMap, WideFootprintsAverage) {
    const trace::CubeMap map(cube_of(
        64, 1, [](const V3d& d, int) { return std::sin(60 * d.x) * std::sin(50 * d.y) > 0; }));
    float out;
    map.lookup({.3, .2, 1}, {{.8, 0, 0}, {0, .8, 0}, 0}, 0, {&out, 1});
    EXPECT_NEAR(static_cast<double>(out), 0.5, 0.05);
    map.lookup({.3, .2, 1}, {none, none, 0.8}, 0, {&out, 1});
    EXPECT_NEAR(static_cast<double>(out), 0.5, 0.05) << "blur";
    map.lookup({NAN, .2, 1}, {none, none, 0}, 0, {&out, 1});
    EXPECT_EQ(out, 0);
}

// A picture that sees more than its face gives the same cube.
TEST(CubeMap, WiderFieldsOfViewAreCut) {
    constexpr double fov_deg = 100;
    const double reach = std::tan(fov_deg * 3.14159265358979 / 360);
    std::array<trace::MapImage, trace::num_cube_faces> pictures;
    for (int face = 0; face < trace::num_cube_faces; ++face) {
        trace::MapImage& p = pictures[static_cast<std::size_t>(face)];
        const trace::CubeFace& c = trace::cube_face(face);
        p.width = p.height = 48;
        p.num_channels = 3;
        for (int y = 0; y < 48; ++y) {
            for (int x = 0; x < 48; ++x) {
                const V3d d =
                    base::normalize(c.forward + reach * ((2 * x + 1) / 48.0 - 1) * c.right +
                                    reach * (1 - (2 * y + 1) / 48.0) * c.up);
                for (int k = 0; k < 3; ++k) {
                    p.values.push_back(static_cast<float>(d[k]));
                }
            }
        }
    }
    const trace::MapImage image = trace::assemble_cube(pictures, fov_deg);
    ASSERT_TRUE(trace::CubeMap::fits(image));
    const trace::CubeMap map(image);
    for (int i = 0; i < 2000; i += 7) {
        const V3d d = spread_direction(i);
        float out[3];
        map.lookup(d, {}, 0, out);
        for (int k = 0; k < 3; ++k) { // two bilinear steps of 1/20
            EXPECT_NEAR(static_cast<double>(out[k]), d[k], 6e-3);
        }
    }
}

TEST(Irradiance, CosineWeightedMeans) {
    // Constant light; and light that is the height above the horizon plus one: 1 + 2/3 n.z
    const trace::Irradiance flat([](const V3d&) { return std::array<float, 3>{2, 1, .5f}; });
    EXPECT_NEAR(flat.around({0, 0, 1})[0], 2, 1e-3); // 64 rows of samples
    EXPECT_NEAR(flat.around({.6, 0, -.8})[2], .5, 1e-3);
    const trace::Irradiance up([](const V3d& d) {
        return std::array<float, 3>{static_cast<float>(1 + d.z), 0, 0};
    });
    EXPECT_NEAR(up.around({0, 0, 1})[0], 1 + 2.0 / 3, 1e-3);
    EXPECT_NEAR(up.around({1, 0, 0})[0], 1, 1e-3);
}

// --- files

class MapFiles : public testing::Test {
protected:
    std::string path(const std::string& name) const { return directory_.path() + "/" + name; }
    base::TempDir directory_{"perigee-test"};
};

TEST_F(MapFiles, ShadowRoundTrip) {
    trace::MapFile map{std::string(trace::shadow_format), {}};
    map.images.push_back(depth_image(100, [](int x, int y) { return 1.5f * float(x) + float(y); }));
    map.images.push_back(depth_image(7, [](int, int) { return 1e38f; }));
    base::OutputFile file(path("a.shd"));
    std::string error;
    ASSERT_TRUE(trace::write_map_file(map, file, error)) << error;
    ASSERT_TRUE(file.commit());
    EXPECT_EQ(trace::map_file_format(path("a.shd")), trace::shadow_format);
    const auto back = trace::read_map_file(path("a.shd"), error);
    ASSERT_TRUE(back) << error;
    ASSERT_EQ(back->images.size(), 2U);
    EXPECT_EQ(back->images[0].values, map.images[0].values);
    EXPECT_EQ(back->images[1].values, map.images[1].values);
    EXPECT_TRUE(back->images[0].has_matrices);
    EXPECT_EQ(std::memcmp(back->images[0].screen_from_world, map.images[0].screen_from_world, 64),
              0);
}

TEST_F(MapFiles, DamagedFilesAreRefused) {
    trace::MapFile map{std::string(trace::shadow_format), {}};
    map.images.push_back(depth_image(64, [](int x, int y) { return float(x * y); }));
    base::OutputFile file(path("a.shd"));
    std::string error;
    ASSERT_TRUE(trace::write_map_file(map, file, error) && file.commit());
    const std::string good = *base::read_file(path("a.shd"));
    for (std::size_t length = 0; length < good.size(); length += 37) {
        ASSERT_EQ(base::write_file_atomically(path("b.shd"), good.substr(0, length)), "");
        (void)trace::read_map_file(path("b.shd"), error); // must return
    }
    std::string lies = good; // every byte of the head, and some of the directory
    for (std::size_t i = 0; i < good.size(); i += i < 16 ? 1 : 53) {
        lies[i] = static_cast<char>(~good[i]);
        ASSERT_EQ(base::write_file_atomically(path("b.shd"), lies), "");
        (void)trace::read_map_file(path("b.shd"), error);
        lies[i] = good[i];
    }
    EXPECT_FALSE(trace::read_map_file(path("none"), error));
    EXPECT_FALSE(error.empty());
    // A zfile whose head promises more than there is.
    std::string zfile(136, '\0');
    const std::uint32_t magic = 0x2f0867ab, size = 0x7fff7fff;
    std::memcpy(zfile.data(), &magic, 4);
    std::memcpy(zfile.data() + 4, &size, 4);
    ASSERT_EQ(base::write_file_atomically(path("c.z"), zfile), "");
    EXPECT_FALSE(trace::read_map_file(path("c.z"), error));
    EXPECT_EQ(error, "it ends too early");
}

// --- point clouds

sl_point_query point_query(const std::string& file, const float* at, float* values) {
    sl_point_query q{};
    q.file = file.c_str();
    q.num_at = 6;
    q.lanes = 8;
    q.mask = 0xff;
    q.at = at;
    q.radius_scale = 1;
    q.num_channels = 1;
    q.channel[0] = {"Ci", SL_TYPE_color, values};
    return q;
}

TEST_F(MapFiles, PointsAreBakedAndFoundAgain) {
    trace::PointFiles files;
    const std::string cloud = path("a.ptc");
    for (int i = 0; i < 50; ++i) {
        float at[48] = {}, values[24] = {};
        for (int lane = 0; lane < 8; ++lane) {
            const float x = static_cast<float>(i), y = static_cast<float>(lane);
            at[lane] = x, at[8 + lane] = y, at[40 + lane] = 1;
            values[lane] = x, values[8 + lane] = y, values[16 + lane] = x + y;
        }
        EXPECT_EQ(files.add(point_query(cloud, at, values), {}), 0xffU);
    }
    EXPECT_TRUE(files.write().empty());
    float at[48] = {}, values[24] = {};
    for (int lane = 0; lane < 8; ++lane) {
        at[lane] = 20.0f + 0.5f * static_cast<float>(lane % 2), at[8 + lane] = 3;
        at[40 + lane] = 1;
    }
    at[47] = -1; // looks the other way
    std::string error;
    EXPECT_EQ(files.lookup(cloud, point_query(cloud, at, values), {}, error), 0x7fU) << error;
    EXPECT_NEAR(values[0], 20, 1e-5) << "on a point";
    EXPECT_NEAR(values[1], 20.5, 1e-5) << "between two";
    EXPECT_NEAR(values[8], 3, 1e-5);
    EXPECT_NEAR(values[17], 23.5, 1e-5);
    sl_point_query near = point_query(cloud, at, values);
    at[0] = 100;
    near.radius = 2;
    EXPECT_EQ(files.lookup(cloud, near, {}, error), 0x7eU) << "too far";
    EXPECT_EQ(files.lookup(path("none"), near, {}, error), 0U);
    EXPECT_FALSE(error.empty());
}

TEST_F(MapFiles, OrderOfSamplesDoesNotShow) {
    std::string texts[2];
    for (int order = 0; order < 2; ++order) {
        trace::PointFiles files;
        for (int i = 0; i < 20; ++i) {
            const int n = order == 0 ? i : 19 - i;
            float at[48] = {}, values[24] = {};
            for (int lane = 0; lane < 8; ++lane) {
                at[lane] = static_cast<float>((n * 8 + lane) % 7);
                values[lane] = n == 3 ? NAN : static_cast<float>(n * 8 + lane);
            }
            (void)files.add(point_query(path("o.ptc"), at, values), {});
        }
        ASSERT_TRUE(files.write().empty());
        texts[order] = *base::read_file(path("o.ptc"));
    }
    EXPECT_EQ(texts[0], texts[1]);
    std::string error;
    for (std::size_t length = 0; length < texts[0].size(); length += 41) {
        ASSERT_EQ(base::write_file_atomically(path("p.ptc"), texts[0].substr(0, length)), "");
        EXPECT_FALSE(trace::read_ply(path("p.ptc"), error));
    }
}

TEST_F(MapFiles, BakeWritesText) {
    trace::PointFiles files;
    float at[16] = {.5f, .25f}, values[8] = {1, 2};
    sl_point_query q{};
    const std::string file = path("a.bake");
    q.file = file.c_str();
    q.num_at = 2;
    q.lanes = 8;
    q.mask = 3;
    q.at = at;
    q.num_channels = 1;
    q.channel[0] = {"value", SL_TYPE_float, values};
    EXPECT_EQ(files.add(q, {}), 3U);
    EXPECT_TRUE(files.write().empty());
    EXPECT_EQ(*base::read_file(file), "# s t value ...\n0.25 0 2\n0.5 0 1\n");
}

} // namespace
