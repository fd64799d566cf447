// SPDX-License-Identifier: Apache-2.0
// Files written by the displays, read back with their libraries; drivers, modes, and what happens
// when writing fails.
#include "runtime/base/file.h"
#include "runtime/base/temp_dir.h"
#include "tracer/display.h"
#include "tracer/display_format.h"
#include "tracer/map_file.h"

#include <OpenEXR/ImfArray.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>

#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <gtest/gtest.h>
#include <png.h>
#include <sys/resource.h>
#include <tiffio.h>
#include <unistd.h>

namespace {

namespace fs = std::filesystem;
using trace::DisplayResult;
using trace::Plane;

constexpr int width = 21, height = 13;
constexpr trace::PixelRange crop{5, 7, 5 + width, 7 + height};

// Every plane a different ramp; color below alpha, some pixels uncovered.
trace::Image test_image() {
    trace::Image image;
    image.pixels = crop;
    for (std::size_t p = 0; p < image.planes.size(); ++p) {
        image.planes[p].resize(crop.area());
        for (std::size_t i = 0; i < crop.area(); ++i) {
            image.planes[p][i] = static_cast<float>((i * (p + 3)) % 256) / 255.0f;
        }
    }
    for (std::size_t i = 0; i < crop.area(); ++i) {
        const float alpha = static_cast<float>(i % 5) / 4;
        image.plane(Plane::A)[i] = alpha;
        for (const Plane p : {Plane::R, Plane::G, Plane::B}) {
            image.plane(p)[i] *= alpha;
        }
        image.plane(Plane::Z)[i] = alpha == 0 ? trace::uncovered_z : 1.25f * static_cast<float>(i);
    }
    return image;
}

class DisplayTest : public testing::Test {
protected:
    DisplayTest() {
        info_.xres = 40;
        info_.yres = 30;
        info_.pixel_aspect = 1.5;
        info_.camera_from_world = base::Mat4::translate({1, 2, 3});
        info_.ndc_from_world = base::Mat4::scale({0.25, -0.5, 1});
    }
    ~DisplayTest() override { std::fclose(null_); }

    [[nodiscard]] std::string path(const std::string& name) const { return (dir_ / name).string(); }
    [[nodiscard]] std::size_t entries() const {
        return static_cast<std::size_t>(std::distance(fs::directory_iterator(dir_), {}));
    }
    [[nodiscard]] rib::Display display(const std::string& name, const std::string& type,
                                       const std::string& mode) const {
        rib::Display d;
        d.name = name[0] == '/' ? name : path(name);
        d.type = type;
        d.mode = mode;
        return d;
    }
    DisplayResult write(const rib::Display& d) {
        const trace::OutputSet outputs({&d, 1}, options_, {}, diag_);
        return trace::write_display(outputs.displays().front(), image_, info_, diag_);
    }
    [[nodiscard]] std::uint64_t warnings() const { return diag_.count(base::Severity::Warning); }

    const base::TempDir temp_{"perigee"};
    const fs::path dir_ = temp_.path();
    std::FILE* null_ = std::fopen("/dev/null", "w");
    base::Diag diag_{null_};
    rib::Options options_;
    trace::Image image_ = test_image();
    trace::PictureInfo info_;
};

void add_string(rib::Display& d, const char* name, const char* value) {
    rib::Param p;
    p.name = name;
    p.decl.type = rib::ParamType::String;
    p.strings = {value};
    d.params.params.push_back(p);
}

void add_floats(rib::Display& d, const char* name, std::vector<float> values) {
    rib::Param p;
    p.name = name;
    p.decl.array_length = static_cast<int>(values.size());
    p.floats = std::move(values);
    d.params.params.push_back(p);
}

struct TiffPicture {
    std::uint32_t width = 0, height = 0;
    std::uint16_t bits = 0, channels = 0, format = 0, photometric = 0, compression = 0;
    std::vector<std::uint16_t> extra;
    float x_position = 0, y_position = 0, resolution = 0;
    std::uint32_t full_width = 0, full_height = 0;
    std::vector<float> camera;
    std::vector<double> values; // interleaved
};

double tiff_value(const TiffPicture& t, const unsigned char* at) {
    const auto get = [&](auto zero) {
        std::memcpy(&zero, at, sizeof zero);
        return static_cast<double>(zero);
    };
    if (t.format == SAMPLEFORMAT_IEEEFP) {
        return get(float{});
    }
    if (t.format == SAMPLEFORMAT_INT) {
        return t.bits == 8    ? get(std::int8_t{})
               : t.bits == 16 ? get(std::int16_t{})
                              : get(std::int32_t{});
    }
    return t.bits == 8    ? get(std::uint8_t{})
           : t.bits == 16 ? get(std::uint16_t{})
                          : get(std::uint32_t{});
}

TiffPicture read_tiff(const std::string& path) {
    TiffPicture t;
    TIFF* file = TIFFOpen(path.c_str(), "r");
    EXPECT_NE(file, nullptr) << path;
    if (file == nullptr) {
        return t;
    }
    TIFFGetField(file, TIFFTAG_IMAGEWIDTH, &t.width);
    TIFFGetField(file, TIFFTAG_IMAGELENGTH, &t.height);
    TIFFGetField(file, TIFFTAG_BITSPERSAMPLE, &t.bits);
    TIFFGetField(file, TIFFTAG_SAMPLESPERPIXEL, &t.channels);
    TIFFGetField(file, TIFFTAG_SAMPLEFORMAT, &t.format);
    TIFFGetField(file, TIFFTAG_PHOTOMETRIC, &t.photometric);
    TIFFGetField(file, TIFFTAG_COMPRESSION, &t.compression);
    std::uint16_t num_extra = 0, *extra = nullptr;
    if (TIFFGetField(file, TIFFTAG_EXTRASAMPLES, &num_extra, &extra) != 0) {
        t.extra.assign(extra, extra + num_extra);
    }
    TIFFGetField(file, TIFFTAG_XPOSITION, &t.x_position);
    TIFFGetField(file, TIFFTAG_YPOSITION, &t.y_position);
    TIFFGetField(file, TIFFTAG_XRESOLUTION, &t.resolution);
    TIFFGetField(file, TIFFTAG_PIXAR_IMAGEFULLWIDTH, &t.full_width);
    TIFFGetField(file, TIFFTAG_PIXAR_IMAGEFULLLENGTH, &t.full_height);
    float* matrix = nullptr;
    if (TIFFGetField(file, TIFFTAG_PIXAR_MATRIX_WORLDTOCAMERA, &matrix) != 0) {
        t.camera.assign(matrix, matrix + 16);
    }
    std::vector<unsigned char> row(static_cast<std::size_t>(TIFFScanlineSize(file)));
    for (std::uint32_t y = 0; y < t.height; ++y) {
        EXPECT_EQ(TIFFReadScanline(file, row.data(), y), 1);
        for (std::uint32_t i = 0; i < t.width * t.channels; ++i) {
            t.values.push_back(tiff_value(t, row.data() + i * t.bits / 8));
        }
    }
    TIFFClose(file);
    return t;
}

TEST_F(DisplayTest, TiffEightBits) {
    EXPECT_EQ(write(display("a.tif", "file", "rgb")), DisplayResult::Written);
    const TiffPicture t = read_tiff(path("a.tif"));
    EXPECT_EQ(t.width, 21U);
    EXPECT_EQ(t.height, 13U);
    EXPECT_EQ(t.bits, 8);
    EXPECT_EQ(t.channels, 3);
    EXPECT_EQ(t.format, SAMPLEFORMAT_UINT);
    EXPECT_EQ(t.photometric, PHOTOMETRIC_RGB);
    EXPECT_TRUE(t.extra.empty());
    for (std::size_t i = 0; i < crop.area(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            // Dither of half a level: at most one level off.
            EXPECT_NEAR(t.values[3 * i + c], 255 * double(image_.planes[c][i]), 1);
        }
    }
    EXPECT_NEAR(t.x_position * t.resolution, 5, 1e-4); // a rational of the float
    EXPECT_NEAR(t.y_position * t.resolution, 7, 1e-4);
    EXPECT_EQ(t.full_width, 40U);
    EXPECT_EQ(t.full_height, 30U);
    ASSERT_EQ(t.camera.size(), 16U);
    EXPECT_EQ(t.camera[12], 1);
    EXPECT_EQ(t.camera[14], 3);
    EXPECT_EQ(warnings(), 0U);
}

TEST_F(DisplayTest, TiffWithDepthIsFloat) {
    EXPECT_EQ(write(display("a.tif", "tiff", "rgbaz")), DisplayResult::Written);
    const TiffPicture t = read_tiff(path("a.tif"));
    EXPECT_EQ(t.bits, 32);
    EXPECT_EQ(t.format, SAMPLEFORMAT_IEEEFP);
    EXPECT_EQ(t.extra,
              (std::vector<std::uint16_t>{EXTRASAMPLE_ASSOCALPHA, EXTRASAMPLE_UNSPECIFIED}));
    constexpr Plane order[] = {Plane::R, Plane::G, Plane::B, Plane::A, Plane::Z};
    for (std::size_t i = 0; i < crop.area(); ++i) {
        for (std::size_t c = 0; c < 5; ++c) {
            ASSERT_EQ(t.values[5 * i + c], double(image_.plane(order[c])[i]));
        }
    }
}

TEST_F(DisplayTest, TiffModesTypesAndCompressions) {
    for (const char* compression : {"none", "lzw", "zip", "packbits"}) {
        for (const rib::Quantize& q : {rib::Quantize{255, 0, 255, 0},
                                       {65535, 0, 65535, 0},
                                       {1e6f, 0, 1e6f, 0},
                                       {100, -100, 100, 0},
                                       {0, 0, 0, 0}}) {
            options_.color_quantize = q;
            rib::Display d = display("a.tif", "tiff", "varying color Ci,a");
            add_string(d, "compression", compression);
            ASSERT_EQ(write(d), DisplayResult::Written);
            const TiffPicture t = read_tiff(path("a.tif"));
            ASSERT_EQ(t.channels, 4);
            for (std::size_t i = 0; i < crop.area(); ++i) {
                const double value = double(image_.plane(Plane::A)[i]);
                ASSERT_EQ(t.values[4 * i + 3],
                          q.one == 0 ? value : std::floor(value * double(q.one) + 0.5));
            }
        }
    }
    EXPECT_EQ(warnings(), 0U);
    for (const auto& [mode, channels] :
         {std::pair{"a", 1}, {"z", 1}, {"az", 2}, {"rgbz", 4}, {"Oi", 3}}) {
        ASSERT_EQ(write(display("a.tif", "tiff", mode)), DisplayResult::Written);
        EXPECT_EQ(read_tiff(path("a.tif")).channels, channels) << mode;
    }
}

TEST_F(DisplayTest, OwnQuantizeAndDither) {
    rib::Display d = display("a.tif", "tiff", "rgb");
    add_floats(d, "quantize", {10, 30, 0, 1000});
    add_floats(d, "dither", {0});
    EXPECT_EQ(write(d), DisplayResult::Written);
    const TiffPicture t = read_tiff(path("a.tif"));
    EXPECT_EQ(t.bits, 16);
    EXPECT_EQ(t.values[3], std::floor(10 + 20 * double(image_.plane(Plane::R)[1]) + 0.5));
}

TEST_F(DisplayTest, ExrHalfWithFloatDepth) {
    EXPECT_EQ(write(display("a.exr", "file", "rgbaz")), DisplayResult::Written);
    Imf::InputFile file(path("a.exr").c_str());
    const Imf::Header& header = file.header();
    EXPECT_EQ(header.displayWindow(), Imath::Box2i({0, 0}, {39, 29}));
    EXPECT_EQ(header.dataWindow(), Imath::Box2i({5, 7}, {25, 19}));
    EXPECT_EQ(header.pixelAspectRatio(), 1.5f);
    EXPECT_EQ(header.channels()["R"].type, Imf::HALF);
    EXPECT_EQ(header.channels()["Z"].type, Imf::FLOAT);
    ASSERT_TRUE(Imf::hasWorldToCamera(header) && Imf::hasWorldToNDC(header));
    EXPECT_EQ(Imf::worldToCamera(header)[3][1], 2);
    EXPECT_EQ(Imf::worldToNDC(header)[1][1], -0.5f);
    std::vector<float> red(crop.area()), depth(crop.area());
    const auto slice = [&](std::vector<float>& to) {
        return Imf::Slice::Make(Imf::FLOAT, to.data(), Imath::V2i(5, 7), width, height);
    };
    Imf::FrameBuffer frame;
    frame.insert("R", slice(red));
    frame.insert("Z", slice(depth));
    file.setFrameBuffer(frame);
    file.readPixels(7, 19);
    for (std::size_t i = 0; i < crop.area(); ++i) {
        const float expected = image_.plane(Plane::R)[i];
        EXPECT_NEAR(red[i], expected, expected / 2048); // half: 11 bits, rounded
        EXPECT_EQ(depth[i], image_.plane(Plane::Z)[i]);
    }
}

TEST_F(DisplayTest, ExrFloatAndCompressions) {
    for (const char* compression : {"none", "rle", "zips", "zip", "piz"}) {
        rib::Display d = display("a", "openexr", "rgb");
        add_string(d, "exrpixeltype", "float");
        add_string(d, "exrcompression", compression);
        ASSERT_EQ(write(d), DisplayResult::Written);
        Imf::InputFile file(path("a").c_str());
        std::vector<float> green(crop.area());
        Imf::FrameBuffer frame;
        frame.insert("G",
                     Imf::Slice::Make(Imf::FLOAT, green.data(), Imath::V2i(5, 7), width, height));
        file.setFrameBuffer(frame);
        file.readPixels(7, 19);
        EXPECT_EQ(green, image_.planes[1]) << compression;
    }
    rib::Display d = display("a", "openexr", "rgb");
    add_string(d, "compression", "wavelet9");
    EXPECT_EQ(write(d), DisplayResult::Written);
    EXPECT_EQ(warnings(), 1U);
}

struct PngPicture {
    int type = 0, bits = 0, x = 0, y = 0;
    std::vector<std::vector<png_byte>> rows;
};

PngPicture read_png(const std::string& path) {
    PngPicture p;
    std::FILE* file = std::fopen(path.c_str(), "rb");
    EXPECT_NE(file, nullptr) << path;
    if (file == nullptr) {
        return p;
    }
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_init_io(png, file); // an error here ends the test program: that is a failure too
    png_read_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
    p.type = png_get_color_type(png, info);
    p.bits = png_get_bit_depth(png, info);
    p.x = png_get_x_offset_pixels(png, info);
    p.y = png_get_y_offset_pixels(png, info);
    for (png_uint_32 y = 0; y < png_get_image_height(png, info); ++y) {
        const png_bytep row = png_get_rows(png, info)[y];
        p.rows.emplace_back(row, row + png_get_rowbytes(png, info));
    }
    png_destroy_read_struct(&png, &info, nullptr);
    std::fclose(file);
    return p;
}

TEST_F(DisplayTest, PngDividesByAlpha) {
    options_.color_quantize.dither = 0;
    EXPECT_EQ(write(display("a.png", "png", "rgba")), DisplayResult::Written);
    const PngPicture p = read_png(path("a.png"));
    EXPECT_EQ(p.type, PNG_COLOR_TYPE_RGB_ALPHA);
    EXPECT_EQ(p.bits, 8);
    EXPECT_EQ(p.x, 5);
    EXPECT_EQ(p.y, 7);
    for (std::size_t i = 0; i < crop.area(); ++i) {
        const png_byte* at = &p.rows[i / width][4 * (i % width)];
        const double alpha = double(image_.plane(Plane::A)[i]),
                     red = double(image_.plane(Plane::R)[i]);
        EXPECT_EQ(at[3], std::floor(255 * alpha + 0.5));
        EXPECT_NEAR(at[0], alpha > 0 ? 255 * red / alpha : 0, 0.501); // rounding
    }
}

TEST_F(DisplayTest, PngSixteenBitsAndGrey) {
    options_.color_quantize = {65535, 0, 65535, 0};
    EXPECT_EQ(write(display("a.png", "png", "a")), DisplayResult::Written);
    const PngPicture p = read_png(path("a.png"));
    EXPECT_EQ(p.type, PNG_COLOR_TYPE_GRAY);
    EXPECT_EQ(p.bits, 16);
    EXPECT_EQ(256 * p.rows[0][4] + p.rows[0][5], 32768); // alpha 0.5: 32767.5
}

TEST_F(DisplayTest, PngKeepsWhatItCan) {
    EXPECT_EQ(write(display("a.png", "file", "rgbz")), DisplayResult::Written);
    EXPECT_EQ(read_png(path("a.png")).type, PNG_COLOR_TYPE_RGB);
    EXPECT_EQ(warnings(), 1U);
    EXPECT_EQ(write(display("b.png", "file", "z")), DisplayResult::Written);
    EXPECT_EQ(read_tiff(path("b.png.tif")).format, SAMPLEFORMAT_IEEEFP);
    EXPECT_EQ(warnings(), 2U);
    options_.color_quantize = {0, 0, 0, 0};
    EXPECT_EQ(write(display("c.png", "file", "rgb")), DisplayResult::Written);
    EXPECT_EQ(read_png(path("c.png")).bits, 16);
    EXPECT_EQ(warnings(), 3U);
}

TEST_F(DisplayTest, RewritingGivesTheSameBytes) {
    for (const char* name : {"a.tif", "a.png", "a.exr"}) {
        ASSERT_EQ(write(display(name, "file", "rgba")), DisplayResult::Written);
        const auto first = base::read_file(path(name));
        ASSERT_EQ(write(display(name, "file", "rgba")), DisplayResult::Written);
        EXPECT_EQ(base::read_file(path(name)), first) << name;
    }
    EXPECT_EQ(entries(), 3U);
}

TEST_F(DisplayTest, Drivers) {
    EXPECT_EQ(write(display("a", "file", "rgb")), DisplayResult::Written); // no extension: TIFF
    EXPECT_EQ(read_tiff(path("a")).channels, 3);
    EXPECT_EQ(warnings(), 0U);
    EXPECT_EQ(write(display("a.pic", "picio", "rgb")), DisplayResult::Written);
    EXPECT_TRUE(fs::exists(path("a.pic.tif")));
    EXPECT_FALSE(fs::exists(path("a.pic")));
    EXPECT_EQ(warnings(), 1U);
    for (const char* type : {"null", "framebuffer", "it"}) { // windows are live_display.cpp's
        EXPECT_EQ(write(display("n", type, "rgb")), DisplayResult::Skipped);
    }
    EXPECT_EQ(warnings(), 1U);
    EXPECT_EQ(write(display("n", "tiff", "nothing")), DisplayResult::Skipped);
    EXPECT_EQ(warnings(), 3U);
    EXPECT_FALSE(fs::exists(path("n")));
    image_ = {};
    EXPECT_EQ(write(display("n", "tiff", "rgb")), DisplayResult::Skipped);
    EXPECT_EQ(warnings(), 4U);
}

TEST_F(DisplayTest, ShadowMaps) {
    EXPECT_EQ(write(display("a.shd", "shadow", "z")), DisplayResult::Written);
    EXPECT_EQ(warnings(), 0U);
    std::string error;
    const auto map = trace::read_map_file(path("a.shd"), error);
    ASSERT_TRUE(map) << error;
    EXPECT_EQ(map->format, trace::shadow_format);
    EXPECT_TRUE(map->images.front().has_matrices);
    EXPECT_EQ(map->images.front().values[1], image_.plane(Plane::Z)[1]);
    EXPECT_EQ(map->images.front().values[0], rib::ri_infinity) << "nothing is there";
    EXPECT_EQ(write(display("b.shd", "deepshad", "z")), DisplayResult::Written);
    EXPECT_EQ(warnings(), 1U) << "opaque depth only";
}

TEST_F(DisplayTest, WindowsAndTheFilesInTheirPlace) {
    EXPECT_TRUE(trace::shows_window(display("n", "framebuffer", "rgb")));
    EXPECT_FALSE(trace::shows_window(display("n", "file", "rgb")));
    EXPECT_FALSE(trace::leaves_file(display("n", "x11", "rgb")));
    EXPECT_FALSE(trace::leaves_file(display("n", "null", "rgb")));
    EXPECT_TRUE(trace::leaves_file(display("n", "unknown", "rgb")));
    const auto name = [&](const char* window) {
        return trace::file_of_window(display(window, "framebuffer", "z"), "scene.tif").name;
    };
    EXPECT_EQ(name("a.png"), path("a.png"));
    EXPECT_EQ(name("scene.rib"), path("scene.rib.tif"));
    EXPECT_EQ(trace::file_of_window({}, "scene.tif").name, "scene.tif");
    EXPECT_EQ(trace::file_of_window({}, "").name, "ri.tif");
}

// Every row of the table, or a TIFF in its place where OpenImageIO is not installed.
TEST_F(DisplayTest, AllFormats) {
    image_.pixels = {5, 7, 5 + 64, 7 + 48}; // JPEG 2000 wants some size
    info_.xres = 80;
    info_.yres = 60;
    for (auto& plane : image_.planes) {
        plane.assign(image_.pixels.area(), 0.25f);
    }
    for (const trace::FormatRow& format : trace::formats()) {
        const std::string type(format.types.substr(0, format.types.find(' ')));
        for (const char* mode : {"rgb", "rgba", "a", "z", "az"}) {
            const std::string name = std::string("x.") + std::string(format.suffix);
            ASSERT_EQ(write(display(name, type, mode)), DisplayResult::Written) << type << mode;
            ASSERT_NE(fs::exists(path(name)), fs::exists(path(name + ".tif"))) << type << mode;
            ASSERT_EQ(entries(), 1U);
            fs::remove(path(name));
            fs::remove(path(name + ".tif"));
        }
    }
}

TEST_F(DisplayTest, FullDiskIsReportedWithItsPlace) {
    for (const char* type : {"tiff", "png", "exr"}) {
        rib::Display d = display("/dev/full", type, "rgba");
        d.pos = {diag_.file_id("scene.rib"), 12, 1};
        EXPECT_EQ(write(d), DisplayResult::Failed) << type;
        EXPECT_EQ(diag_.last_code(), base::Code::DiskFull) << type;
        const std::string message = diag_.messages().back();
        EXPECT_EQ(
            message.find("scene.rib:12:1: severe: Display: cannot write /dev/full: No space left"),
            0U)
            << message;
    }
    EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST_F(DisplayTest, PlacesThatCannotBeWritten) {
    EXPECT_EQ(write(display("no/such/a.tif", "file", "rgb")), DisplayResult::Failed);
    EXPECT_EQ(write(display("/proc/a.png", "file", "rgb")),
              DisplayResult::Failed); // read-only even for root
    EXPECT_EQ(write(display(".", "exr", "rgb")), DisplayResult::Failed);
    EXPECT_EQ(entries(), 0U);
}

// The file system refuses to go on in the middle of the file.
TEST_F(DisplayTest, FailureHalfwayLeavesNothing) {
    rlimit old{};
    ::getrlimit(RLIMIT_FSIZE, &old);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit tiny{500, old.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &tiny);
    for (const char* name : {"a.tif", "a.png", "a.exr"}) {
        EXPECT_EQ(write(display(name, "file", "rgbaz")), DisplayResult::Failed) << name;
    }
    ::setrlimit(RLIMIT_FSIZE, &old);
    std::signal(SIGXFSZ, handler);
    EXPECT_EQ(entries(), 0U);
}

TEST(Picture, InfoFromCamera) {
    rib::Scene scene;
    scene.options.projection = "perspective";
    scene.options.frame_aspect =
        1; // 480 of 640 columns; fov 90: the picture spans -1 to 1 at z = 1
    scene.camera_from_world.keys[0].m = base::Mat4::translate({0, 0, 5});
    base::Diag diag;
    const trace::PictureInfo info = trace::picture_info(trace::Camera(scene, diag));
    constexpr double eps = 1e-12; // a few double operations
    EXPECT_EQ(info.xres, 640);
    const base::V3d centre = base::point(info.ndc_from_world, {0, 0, 0});
    EXPECT_NEAR(centre.x, 240.0 / 640, eps);
    EXPECT_NEAR(centre.y, 0.5, eps);
    EXPECT_EQ(info.camera_from_world.m[3][2], 5);
    EXPECT_NEAR(info.window_width, 640.0 / 240, eps);
    EXPECT_NEAR(info.window_center[0], -1 + 320.0 / 240, eps);
    EXPECT_NEAR(info.window_center[1], 0, eps);
}

} // namespace
