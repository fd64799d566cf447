// SPDX-License-Identifier: Apache-2.0
// Lookups of pictures through OpenImageIO as shaders ask for them: mapping, filters against
// integrals, wrap modes, channels, environments, what is missing or damaged, and maps made by
// make_map().
#include "runtime/base/file.h"
#include "runtime/base/temp_dir.h"
#include "tracer/texture_frame.h"
#include "tracer/texture_make.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <vector>

namespace {

constexpr double pi = 3.14159265358979323846;

class TextureTest : public testing::Test {
protected:
    TextureTest() { options_.search_paths["texture"] = {directory_.path()}; }

    void SetUp() override {
        std::string error;
        if (trace::texture_module(error) == nullptr) {
            GTEST_SKIP() << error;
        }
    }

    std::string path(const std::string& name) const { return directory_.path() + "/" + name; }

    // A picture of one directory: f(x, y, channel) at the middle of every pixel, 0..1 across.
    template <class F>
    void picture(const std::string& name, int width, int height, int channels, const F& f) {
        trace::MapFile map;
        trace::MapImage image;
        image.width = width;
        image.height = height;
        image.num_channels = channels;
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                for (int k = 0; k < channels; ++k) {
                    image.values.push_back(
                        static_cast<float>(f((x + .5) / width, (y + .5) / height, k)));
                }
            }
        }
        map.images.push_back(std::move(image));
        base::OutputFile file(path(name));
        std::string error;
        ASSERT_TRUE(trace::write_map_file(map, file, error) && file.commit()) << error;
    }

    // A query of one lane with defaults.
    sl_map_query query(int kind, const std::string& name, int channels) {
        names_.push_back(std::make_unique<std::string>(name));
        sl_map_query q{};
        q.kind = kind;
        q.num_channels = channels;
        q.lanes = 8;
        q.mask = 1;
        q.name[0] = names_.back()->c_str();
        for (int lane = 0; lane < 8; ++lane) {
            q.option[SL_MAP_OPTION_swidth][lane] = q.option[SL_MAP_OPTION_twidth][lane] = 1;
            q.option[SL_MAP_OPTION_samples][lane] = 16;
        }
        return q;
    }
    sl_map_query texture(const std::string& name, double s, double t, int channels = 1) {
        sl_map_query q = query(SL_MAP_texture, name, channels);
        q.at[0] = static_cast<float>(s);
        q.at[8] = static_cast<float>(t);
        return q;
    }
    static sl_map_query wide(sl_map_query q, double ds, double dt) {
        q.du[0] = static_cast<float>(ds);
        q.dv[8] = static_cast<float>(dt);
        return q;
    }
    sl_map_query environment(const std::string& name, const base::V3d& R, int channels = 3) {
        sl_map_query q = query(SL_MAP_environment, name, channels);
        for (int k = 0; k < 3; ++k) {
            q.at[8 * k] = static_cast<float>(R[k]);
        }
        return q;
    }

    trace::TextureFrame& frame() {
        if (!frame_) {
            frame_ = std::make_unique<trace::TextureFrame>(textures_, options_, base::Mat4{});
        }
        return *frame_;
    }
    std::vector<double> ask(const sl_map_query& q) {
        float result[3 * 8] = {};
        frame().lookup(
            q, {}, [&](const std::string& text) { said_.push_back(text); }, result);
        std::vector<double> out;
        for (int k = 0; k < q.num_channels; ++k) {
            out.push_back(static_cast<double>(result[8 * k]));
        }
        return out;
    }
    double value(const sl_map_query& q) { return ask(q).front(); }

    base::TempDir directory_{"perigee-test"};
    rib::Options options_;
    trace::Textures textures_;
    std::unique_ptr<trace::TextureFrame> frame_;
    std::vector<std::unique_ptr<std::string>> names_;
    std::vector<std::string> said_;
};

double ramp(double x, double, int) {
    return x;
}

TEST_F(TextureTest, SRunsRightAndTDown) {
    picture("st.tif", 64, 32, 3, [](double x, double y, int k) {
        return k == 0 ? x : k == 1 ? y : .25;
    });
    for (const double s : {.1, .37, .5, .93}) {
        for (const double t : {.06, .4, .81}) {
            const auto got = ask(texture("st.tif", s, t, 3));
            EXPECT_NEAR(got[0], s, 1e-5); // linear between texels
            EXPECT_NEAR(got[1], t, 1e-5);
            EXPECT_NEAR(got[2], .25, 1e-6);
        }
    }
    EXPECT_TRUE(said_.empty());
}

// The mean over a footprint of a ramp is its middle, whatever the filter.
TEST_F(TextureTest, FootprintsKeepARamp) {
    picture("ramp.tif", 128, 128, 1, ramp);
    for (const char* filter : {"box", "gaussian", "triangle", "catmull-rom", "disk", "odd"}) {
        for (const double width : {.01, .05, .2}) {
            sl_map_query q = wide(texture("ramp.tif", .45, .5), width, width / 3);
            q.filter = filter;
            // Mip levels are sampled at finitely many places.
            EXPECT_NEAR(value(q), .45, .003) << filter << " " << width;
        }
    }
}

TEST_F(TextureTest, LargeFootprintsAverageACheckerboard) {
    picture("check.tif", 64, 64, 1, [](double x, double y, int) {
        return (static_cast<int>(x * 64) + static_cast<int>(y * 64)) % 2;
    });
    EXPECT_NEAR(value(wide(texture("check.tif", .5, .5), .3, .3)), .5, 1e-3);
    EXPECT_NEAR(value(wide(texture("check.tif", .5, .5), .3, .02)), .5, .02) << "long and thin";
    sl_map_query q = texture("check.tif", .5, .5);
    q.option[SL_MAP_OPTION_sblur][0] = q.option[SL_MAP_OPTION_tblur][0] = .2f;
    EXPECT_NEAR(value(q), .5, 1e-3) << "blur";
    q = wide(texture("check.tif", 24.5 / 64, 24.5 / 64), .3, .3);
    q.option[SL_MAP_OPTION_swidth][0] = q.option[SL_MAP_OPTION_twidth][0] = 0;
    EXPECT_NEAR(value(q), 0, 1e-6) << "width 0: one texel";
}

// Across an edge: between the box and the Gaussian of the footprint's width; the lookup is neither
// exactly, see docs/textures.md.
TEST_F(TextureTest, AnEdgeIsFilteredAsWideAsTheFootprint) {
    picture("edge.tif", 256, 256, 1, [](double x, double, int) { return x < .5 ? 0 : 1; });
    constexpr double width = .25;
    for (double offset = -.2; offset < .21; offset += .05) {
        const double box = std::clamp(.5 + offset / width, 0., 1.);
        const double gaussian = .5 + .5 * std::erf(offset / (width / 2));
        const double got = value(wide(texture("edge.tif", .5 + offset, .5), width, width));
        EXPECT_NEAR(got, .5 * (box + gaussian), .08) << offset;
    }
}

TEST_F(TextureTest, WrapModesOfTheFile) {
    picture("ramp.tif", 64, 64, 1, ramp);
    for (const char* mode : {"black", "periodic", "clamp"}) {
        trace::MakeRequest make;
        make.sources = {path("ramp.tif")};
        make.target = path(std::string(mode) + ".tx");
        make.smode = make.tmode = mode;
        const trace::MakeOutcome outcome = trace::make_map(make);
        ASSERT_TRUE(outcome.made) << outcome.error;
    }
    EXPECT_NEAR(value(texture("ramp.tif", 1.3, .5)), 0, 1e-6) << "plain pictures are black beyond";
    EXPECT_NEAR(value(texture("black", -.3, .5)), 0, 1e-6) << "black.tx, found without .tx";
    EXPECT_NEAR(value(texture("periodic.tx", 1.3, .5)), .3, 1e-3);
    EXPECT_NEAR(value(texture("periodic.tx", -.3, 7.5)), .7, 1e-3);
    EXPECT_NEAR(value(texture("clamp.tx", 1.3, .5)), 1 - .5 / 64, 1e-3);
}

// sl.md 6.4: a difference that jumps at a seam goes the short way round.
TEST_F(TextureTest, SeamsOfPeriodicTexturesStaySharp) {
    picture("wave.tif", 256, 256, 1,
            [](double x, double, int) { return .5 + .5 * std::sin(2 * pi * x * 8); });
    trace::MakeRequest make;
    make.sources = {path("wave.tif")};
    make.target = path("wave.tx");
    make.smode = make.tmode = "periodic";
    ASSERT_TRUE(trace::make_map(make).made);
    const double s = 1 - 1.0 / 32; // a trough
    const double plain = value(wide(texture("wave.tx", s, .5), .002, .002));
    EXPECT_NEAR(plain, 0, .02);
    EXPECT_NEAR(value(wide(texture("wave.tx", s, .5), .002 - 1, .002)), plain, 1e-3);
    // The middle of a footprint counts more than its ends.
    EXPECT_NEAR(value(wide(texture("wave.tx", s, .5), 1e6, .002)), .5, .08) << "at most all of it";
    EXPECT_NEAR(value(wide(texture("wave.tx", s, .5), NAN, .002)), plain, .02) << "no number: none";
}

TEST_F(TextureTest, ChannelsAndFill) {
    picture("four.tif", 8, 8, 4, [](double, double, int k) { return .2 * (k + 1); });
    picture("one.tif", 8, 8, 1, [](double, double, int) { return .6; });
    sl_map_query q = texture("four.tif", .5, .5);
    q.channel = 3;
    EXPECT_NEAR(value(q), .8, 1e-5);
    q.channel = 4;
    EXPECT_EQ(value(q), 0);
    q.option[SL_MAP_OPTION_fill][0] = 1;
    q.given = 1U << SL_MAP_OPTION_fill;
    EXPECT_EQ(value(q), 1) << "alpha or opaque";
    q = texture("four.tif", .5, .5, 3);
    q.channel = 2;
    EXPECT_NEAR(ask(q)[1], .8, 1e-5);
    EXPECT_EQ(ask(q)[2], 0);
    q = texture("one.tif", .5, .5, 3);
    EXPECT_NEAR(ask(q)[2], .6, 1e-5) << "grey";
    q.given = 1U << SL_MAP_OPTION_fill;
    q.option[SL_MAP_OPTION_fill][0] = .3f;
    EXPECT_NEAR(ask(q)[0], .6, 1e-5);
    EXPECT_NEAR(ask(q)[2], .3, 1e-5) << "strictly, with a fill value";
}

TEST_F(TextureTest, LanesMayNameDifferentMaps) {
    picture("a.tif", 8, 8, 1, [](double, double, int) { return .25; });
    picture("b.tif", 8, 8, 1, [](double, double, int) { return .75; });
    sl_map_query q = texture("a.tif", .5, .5);
    const sl_map_query other = texture("b.tif", .5, .5);
    for (int lane = 0; lane < 8; ++lane) {
        q.name[lane] = lane % 3 == 1 ? other.name[0] : q.name[0];
        q.at[lane] = q.at[8 + lane] = .5f;
    }
    q.mask = 0xff;
    float result[8] = {};
    frame().lookup(
        q, {}, [](const std::string&) {}, result);
    for (int lane = 0; lane < 8; ++lane) {
        EXPECT_NEAR(result[lane], lane % 3 == 1 ? .75 : .25, 1e-6);
    }
}

TEST_F(TextureTest, BumpGivesSlopes) {
    picture("hill.tif", 256, 256, 1,
            [](double x, double y, int) { return .5 * x + .1 * std::sin(2 * pi * y); });
    sl_map_query q = query(SL_MAP_bump, "hill.tif", 2);
    q.at[0] = .4f;
    q.at[8] = .3f;
    const auto slopes = ask(q);
    EXPECT_NEAR(slopes[0], .5, .01);
    // The cubic filter smooths over four texels of 1/256: a few thousandths of the slope.
    EXPECT_NEAR(slopes[1], .1 * 2 * pi * std::cos(2 * pi * .3), .01);
}

// --- environments

TEST_F(TextureTest, LatitudeAndLongitude) {
    picture("ll.tif", 256, 128, 3, [](double x, double y, int k) {
        return k == 0 ? x : k == 1 ? y : 1;
    });
    for (int i = 0; i < 300; ++i) {
        const double z = 1 - (2 * i + 1) / 300.0, a = i * 2.399963229728653;
        const base::V3d R{std::sqrt(1 - z * z) * std::cos(a), std::sqrt(1 - z * z) * std::sin(a),
                          z};
        const double s = .5 + std::atan2(R.y, R.x) / (2 * pi), t = std::acos(z) / pi;
        if (s < .01 || s > .99 || t < .01 || t > .99) {
            continue; // the ramp jumps there
        }
        const auto got = ask(environment("ll.tif", 3.0 * R));
        EXPECT_NEAR(got[0], s, 1e-4);
        EXPECT_NEAR(got[1], t, 1e-4);
    }
}

TEST_F(TextureTest, LatLongHasNoSeamAndAPole) {
    picture("ll.tif", 256, 128, 1, [](double x, double y, int) {
        const double theta = y * pi, phi = (x - .5) * 2 * pi;
        return .5 + .25 * std::sin(theta) * std::cos(phi) + .25 * std::cos(theta);
    });
    const auto expected = [](const base::V3d& R) {
        return .5 + .25 * R.x / base::length(R) + .25 * R.z / base::length(R);
    };
    for (int i = 0; i < 100; ++i) { // across -x, and over the pole
        for (const base::V3d& R :
             {base::V3d{-1, (i - 50) * 1e-3, .2}, base::V3d{(i - 50) * 1e-3, 1e-4, 1}}) {
            sl_map_query q = environment("ll.tif", R, 1);
            for (int k = 0; k < 3; ++k) {
                q.du[8 * k] = static_cast<float>(k == 0 ? .01 * R.z : 0);
                q.dv[8 * k] = static_cast<float>(k == 1 ? .01 : 0);
            }
            EXPECT_NEAR(value(q), expected(R), .01) << R.x << " " << R.y;
        }
    }
}

TEST_F(TextureTest, IrradianceOfAnEnvironment) {
    picture("sky.tif", 128, 64, 3,
            [](double, double y, int k) { return k == 0 ? 1 + std::cos(y * pi) : 1; });
    sl_map_query q = query(SL_MAP_irradiance, "sky.tif", 3);
    q.at[16] = 1; // up
    EXPECT_NEAR(ask(q)[0], 1 + 2.0 / 3, .01);
    EXPECT_NEAR(ask(q)[1], 1, .01);
    EXPECT_TRUE(said_.empty());
}

TEST_F(TextureTest, CubesAreMadeOfSixPictures) {
    trace::MakeRequest make;
    make.kind = trace::MapKind::Cube;
    for (int face = 0; face < trace::num_cube_faces; ++face) {
        const trace::CubeFace& c = trace::cube_face(face);
        const std::string name = "face" + std::to_string(face) + ".tif";
        picture(name, 64, 64, 3, [&](double x, double y, int k) {
            const base::V3d d =
                base::normalize(c.forward + (2 * x - 1) * c.right + (1 - 2 * y) * c.up);
            return .5 + .5 * d[k];
        });
        make.sources.push_back(path(name));
    }
    make.target = path("room.env");
    const trace::MakeOutcome outcome = trace::make_map(make);
    ASSERT_TRUE(outcome.made) << outcome.error;
    for (int i = 0; i < 200; ++i) {
        const double z = 1 - (2 * i + 1) / 200.0, a = i * 2.399963229728653;
        const base::V3d R{std::sqrt(1 - z * z) * std::cos(a), std::sqrt(1 - z * z) * std::sin(a),
                          z};
        const auto got = ask(environment("room.env", R));
        for (int k = 0; k < 3; ++k) {
            EXPECT_NEAR(got[static_cast<std::size_t>(k)], .5 + .5 * R[k], 2e-3);
        }
    }
    sl_map_query blurred = environment("room.env", {0, 0, 1});
    blurred.option[SL_MAP_OPTION_sblur][0] = blurred.option[SL_MAP_OPTION_tblur][0] = 1;
    EXPECT_NEAR(ask(blurred)[0], .5, .1);
    EXPECT_EQ(frame().info("room.env", "type").text, "environment");
    make.sources.pop_back();
    EXPECT_FALSE(trace::make_map(make).made);
}

// --- what is not there

TEST_F(TextureTest, MissingMapsGiveTheirFallback) {
    sl_map_query q = texture("none.tif", .5, .5, 3);
    q.option[SL_MAP_OPTION_fill][0] = .4f;
    EXPECT_NEAR(ask(q)[1], .4, 1e-6);
    EXPECT_EQ(said_.back(), "cannot read the map \"none.tif\": no such file");
    q = query(SL_MAP_shadow, "none.shd", 1);
    q.option[SL_MAP_OPTION_fill][0] = .4f;
    EXPECT_EQ(value(q), 0);
    q = query(SL_MAP_bump, "none.tif", 2);
    EXPECT_EQ(value(q), 0);
    EXPECT_TRUE(frame().info("none.tif", "exists").numbers.empty());
    picture("plain.tif", 8, 8, 1, ramp);
    EXPECT_EQ(value(query(SL_MAP_shadow, "plain.tif", 1)), 0) << "no shadow map";
    EXPECT_NE(said_.back().find("no shadow map"), std::string::npos);
}

TEST_F(TextureTest, DamagedFilesCostAMessage) {
    picture("good.tif", 256, 256, 3, ramp);
    const std::string good = *base::read_file(path("good.tif"));
    int number = 0;
    for (std::size_t length = 0; length < good.size(); length += good.size() / 12 + 1) {
        const std::string name = "cut" + std::to_string(number++) + ".tif";
        ASSERT_EQ(base::write_file_atomically(path(name), good.substr(0, length)), "");
        said_.clear();
        const auto got = ask(texture(name, .9, .9, 3));
        EXPECT_TRUE(std::isfinite(got[0]));
        EXPECT_FALSE(said_.empty()) << name;
    }
    // A head that promises four thousand million pixels.
    std::string huge("P6\n65535 65535\n255\n");
    ASSERT_EQ(base::write_file_atomically(path("huge.ppm"), huge + "abc"), "");
    said_.clear();
    (void)ask(texture("huge.ppm", .5, .5, 3));
    EXPECT_FALSE(said_.empty());
}

TEST_F(TextureTest, AMapThatIsMadeAgainIsReadAgain) {
    picture("map.tif", 8, 8, 1, [](double, double, int) { return .25; });
    EXPECT_NEAR(value(texture("map.tif", .5, .5)), .25, 1e-6);
    frame_.reset();
    picture("map.tif", 8, 8, 1, [](double, double, int) { return .75; });
    textures_.changed(path("map.tif"));
    EXPECT_NEAR(value(texture("map.tif", .5, .5)), .75, 1e-6);
}

TEST_F(TextureTest, TextureInfo) {
    picture("st.tif", 64, 32, 4, ramp);
    EXPECT_EQ(frame().info("st.tif", "resolution").numbers, (std::vector<float>{64, 32}));
    EXPECT_EQ(frame().info("st.tif", "channels").numbers, (std::vector<float>{4}));
    EXPECT_EQ(frame().info("st.tif", "type").text, "texture");
    EXPECT_EQ(frame().info("st.tif", "exists").numbers, (std::vector<float>{1}));
    EXPECT_TRUE(frame().info("st.tif", "viewingmatrix").numbers.empty());
    EXPECT_TRUE(frame().info("st.tif", "colour").numbers.empty());
}

TEST_F(TextureTest, MakingSaysWhatItCannotDo) {
    picture("st.tif", 30, 20, 3, ramp);
    trace::MakeRequest make;
    make.sources = {path("st.tif")};
    make.target = path("st.tx");
    make.smode = "sideways";
    make.filter = "odd";
    const trace::MakeOutcome made = trace::make_map(make);
    EXPECT_TRUE(made.made) << made.error;
    EXPECT_EQ(made.notes.size(), 2U);
    make.sources = {path("none.tif")};
    EXPECT_FALSE(trace::make_map(make).made);
    make.sources = {path("st.tif")};
    make.target = path("no/such/folder/st.tx");
    const trace::MakeOutcome unwritable = trace::make_map(make);
    EXPECT_FALSE(unwritable.made);
    EXPECT_TRUE(unwritable.environment);
    make.kind = trace::MapKind::Shadow;
    make.target = path("st.shd");
    EXPECT_FALSE(trace::make_map(make).made) << "no matrices";
}

} // namespace
