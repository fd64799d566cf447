// SPDX-License-Identifier: Apache-2.0
// perigee_oiio.so: writes the picture formats Perigee has no writer of its own for, through
// OpenImageIO, which brings some 260 libraries: no other part of the program may link it. Formats
// that OpenImageIO writes into memory are; others go through a file in a private directory.
#include "tracer/oiio_module.h"

#include "runtime/base/temp_dir.h"
#include "tracer/oiio_library.h"

#include <cstdio>
#include <exception>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

namespace {

OIIO::ImageSpec spec_of(const OIIO::ImageOutput& out, const perigee_oiio_picture& p) {
    const OIIO::TypeDesc type = p.bits == 8    ? OIIO::TypeDesc::UINT8
                                : p.bits == 16 ? OIIO::TypeDesc::UINT16
                                               : OIIO::TypeDesc::FLOAT;
    OIIO::ImageSpec spec(p.width, p.height, p.num_channels, type);
    if (out.supports("origin") != 0) {
        spec.x = p.x;
        spec.y = p.y;
    }
    if (out.supports("displaywindow") != 0) {
        spec.full_width = p.frame_width;
        spec.full_height = p.frame_height;
    }
    spec.alpha_channel = p.alpha;
    // Pixels are as the format wants them; nothing is to be divided again.
    spec.attribute("oiio:UnassociatedAlpha", p.alpha_divided);
    spec.attribute("PixelAspectRatio", p.pixel_aspect);
    spec.attribute("CompressionQuality", p.quality);
    spec.attribute("Software", "Perigee");
    spec.attribute("oiio:dither", 0); // has been done
    // jpeg:60 and the like, as OpenImageIO has it
    if (p.compression[0] != '\0') {
        spec.attribute("Compression", p.compression);
    } else if (std::string(p.suffix) == "jpg" || std::string(p.suffix) == "webp") {
        spec.attribute("Compression", (std::string(p.suffix) == "jpg" ? "jpeg:" : "webp:") +
                                          std::to_string(p.quality));
    }
    spec.attribute("worldtocamera", OIIO::TypeMatrix, p.camera_from_world);
    spec.attribute("worldtoscreen", OIIO::TypeMatrix, p.screen_from_world);
    return spec;
}

bool write_pixels(OIIO::ImageOutput& out, const perigee_oiio_picture& p, const std::string& name,
                  std::string& why) {
    const OIIO::ImageSpec spec = spec_of(out, p);
    const bool good = out.open(name, spec) && out.write_image(spec.format, p.pixels) && out.close();
    why = out.geterror(); // some writers say that all is well, and leave only this
    return good && why.empty();
}

using Writer = std::unique_ptr<OIIO::ImageOutput>;

// The writer goes before the memory it writes to.
bool write_to_memory(Writer out, const perigee_oiio_picture& p, std::vector<unsigned char>& bytes,
                     std::string& why) {
    OIIO::Filesystem::IOVecOutput memory(bytes);
    const bool good =
        out->set_ioproxy(&memory) && write_pixels(*out, p, std::string("picture.") + p.suffix, why);
    out.reset();
    return good;
}

bool write_through_file(Writer out, const perigee_oiio_picture& p,
                        std::vector<unsigned char>& bytes, std::string& why) {
    const base::TempDir directory("perigee");
    if (directory.path().empty()) {
        why = "no temporary directory";
        return false;
    }
    const std::string name = directory.path() + "/picture." + p.suffix;
    if (!write_pixels(*out, p, name, why)) {
        return false;
    }
    out.reset();
    std::ifstream file(name, std::ios::binary);
    bytes.assign(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
    if (!file.good() && !file.eof()) {
        why = "the temporary file cannot be read";
        return false;
    }
    return true;
}

bool write(const perigee_oiio_picture& p, perigee_oiio_sink sink, void* user, std::string& why) {
    // One thread: the bytes repeat.
    OIIO::attribute("threads", 1);
    Writer out = OIIO::ImageOutput::create(std::string("picture.") + p.suffix);
    if (!out) {
        why = OIIO::geterror();
        return false;
    }
    std::vector<unsigned char> bytes;
    const bool in_memory = out->supports("ioproxy") != 0;
    const bool written = in_memory ? write_to_memory(std::move(out), p, bytes, why)
                                   : write_through_file(std::move(out), p, bytes, why);
    return written && sink(user, bytes.data(), bytes.size()) != 0;
}

} // namespace

extern "C" __attribute__((visibility("default"))) int
perigee_oiio_write(const perigee_oiio_picture* picture, perigee_oiio_sink sink, void* user,
                   char* error, size_t error_size) {
    std::string why;
    int good = 0;
    try {
        good = write(*picture, sink, user, why) ? 1 : 0;
    } catch (const std::exception& e) {
        why = e.what();
    } catch (...) {
        why = "unknown error";
    }
    std::snprintf(error, error_size, "%s", why.c_str());
    return good;
}
