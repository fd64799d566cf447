// SPDX-License-Identifier: Apache-2.0
// The texture side of perigee_oiio.so: OpenImageIO's TextureSystem behind texture_module.h. In:
// packets of lookups. Out: filtered values, or an error text; no exception leaves. Pictures that
// are neither tiled nor mip-mapped are both on the fly, within the memory that set_memory() allows.
#include "runtime/base/temp_dir.h"
#include "tracer/oiio_library.h"
#include "tracer/texture_module.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fstream>
#include <memory>
#include <mutex>
#include <sstream>
#include <string>
#include <vector>

namespace {

constexpr int autotile_px = 64;
constexpr int most_channels = 64;
constexpr std::int64_t most_pixels = std::int64_t{1} << 34;

struct Error {
    char* text;
    std::size_t size;
    void operator()(const std::string& what) const {
        if (text != nullptr && size > 0) {
            std::snprintf(text, size, "%s", what.c_str());
        }
    }
};

// Runs f; what it throws becomes an error text and the fallback.
template <class Result, class F> Result guarded(const Error& error, Result fallback, F&& f) {
    try {
        return f();
    } catch (const std::exception& e) {
        error(e.what());
    } catch (...) {
        error("unknown error");
    }
    return fallback;
}

OIIO::TextureSystem& system_of(void* system) {
    return *static_cast<OIIO::TextureSystem*>(system);
}

void* create(char* text, std::size_t size) {
    return guarded<void*>({text, size}, nullptr, []() -> void* {
        OIIO::TextureSystem* system = OIIO::TextureSystem::create(false);
        system->attribute("automip", 1);
        system->attribute("autotile", autotile_px);
        system->attribute("accept_untiled", 1);
        system->attribute("accept_unmipped", 1);
        return system;
    });
}

void destroy(void* system) {
    guarded<int>({nullptr, 0}, 0, [&] {
        OIIO::TextureSystem::destroy(&system_of(system), true);
        return 0;
    });
}

void set_memory(void* system, float megabytes) {
    guarded<int>({nullptr, 0}, 0, [&] {
        system_of(system).attribute("max_memory_MB", megabytes);
        return 0;
    });
}

// --- files

int wrap_mode(OIIO::Tex::Wrap wrap) {
    switch (wrap) {
    case OIIO::Tex::Wrap::Clamp:
        return PERIGEE_WRAP_clamp;
    case OIIO::Tex::Wrap::Periodic:
    case OIIO::Tex::Wrap::PeriodicPow2:
    case OIIO::Tex::Wrap::PeriodicSharedBorder:
        return PERIGEE_WRAP_periodic;
    case OIIO::Tex::Wrap::Mirror:
        return PERIGEE_WRAP_mirror;
    default:
        return PERIGEE_WRAP_black;
    }
}

bool get_matrix(const OIIO::ImageSpec& spec, const char* name, float* out) {
    const OIIO::ParamValue* p = spec.find_attribute(name, OIIO::TypeMatrix);
    if (p == nullptr) {
        return false;
    }
    std::memcpy(out, p->data(), 16 * sizeof(float));
    return true;
}

void describe(const OIIO::ImageSpec& spec, perigee_texture_info& info) {
    info = {};
    info.width = spec.full_width > 0 ? spec.full_width : spec.width;
    info.height = spec.full_height > 0 ? spec.full_height : spec.height;
    info.num_channels = spec.nchannels;
    info.alpha = spec.alpha_channel;
    OIIO::Tex::Wrap wrap[2] = {OIIO::Tex::Wrap::Black, OIIO::Tex::Wrap::Black};
    const std::string modes = spec.get_string_attribute("wrapmodes");
    if (!modes.empty()) {
        OIIO::Tex::parse_wrapmodes(modes.c_str(), wrap[0], wrap[1]);
    }
    info.wrap[0] = wrap_mode(wrap[0]);
    info.wrap[1] = wrap_mode(wrap[1]);
    std::snprintf(info.format, sizeof info.format, "%s",
                  std::string(spec.get_string_attribute("textureformat")).c_str());
    info.has_matrices = get_matrix(spec, "worldtocamera", info.camera_from_world) &&
                                get_matrix(spec, "worldtoscreen", info.screen_from_world)
                            ? 1
                            : 0;
}

std::string size_problem(const OIIO::ImageSpec& spec) {
    const bool too_big = spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0 ||
                         spec.nchannels > most_channels ||
                         std::int64_t{spec.width} * spec.height > most_pixels;
    return too_big
               ? "its size, " + std::to_string(spec.width) + " by " + std::to_string(spec.height) +
                     " pixels of " + std::to_string(spec.nchannels) + " channels, cannot be right"
               : "";
}

void* open(void* system, const char* path, perigee_texture_info* info, char* text,
           std::size_t size) {
    const Error error{text, size};
    return guarded<void*>(error, nullptr, [&]() -> void* {
        OIIO::TextureSystem& ts = system_of(system);
        const OIIO::ustring name(path);
        OIIO::TextureSystem::TextureHandle* handle = ts.get_texture_handle(name);
        const OIIO::ImageSpec* spec =
            handle != nullptr && ts.good(handle) ? ts.imagespec(handle) : nullptr;
        if (spec == nullptr) {
            const std::string why = ts.geterror();
            error(why.empty() ? "no picture in a known format" : why);
            return nullptr;
        }
        if (const std::string problem = size_problem(*spec); !problem.empty()) {
            error(problem);
            return nullptr;
        }
        describe(*spec, *info);
        return handle;
    });
}

void invalidate(void* system, const char* path) {
    guarded<int>({nullptr, 0}, 0, [&] {
        if (path != nullptr) {
            system_of(system).invalidate(OIIO::ustring(path));
        } else {
            system_of(system).invalidate_all(false);
        }
        return 0;
    });
}

// --- lookups

OIIO::TextureOpt::Wrap wrap_of(int wrap) {
    constexpr OIIO::TextureOpt::Wrap modes[] = {
        OIIO::TextureOpt::WrapBlack, OIIO::TextureOpt::WrapClamp, OIIO::TextureOpt::WrapPeriodic,
        OIIO::TextureOpt::WrapMirror};
    return modes[wrap];
}

OIIO::TextureOpt options_of(const perigee_texture_query& q) {
    OIIO::TextureOpt opt;
    opt.firstchannel = q.channel;
    opt.swrap = wrap_of(q.wrap[0]);
    opt.twrap = wrap_of(q.wrap[1]);
    opt.mipmode = OIIO::TextureOpt::MipModeAniso;
    opt.interpmode = q.by_s != nullptr                  ? OIIO::TextureOpt::InterpBicubic
                     : q.filter == PERIGEE_FILTER_cubic ? OIIO::TextureOpt::InterpSmartBicubic
                                                        : OIIO::TextureOpt::InterpBilinear;
    opt.conservative_filter = false; // the footprint is what the shader asked for
    return opt;
}

int lookup(void* system, const perigee_texture_query* query, char* text, std::size_t size) {
    const Error error{text, size};
    return guarded<int>(error, 0, [&] {
        const perigee_texture_query& q = *query;
        OIIO::TextureSystem& ts = system_of(system);
        OIIO::TextureSystem::Perthread* thread = ts.get_perthread_info();
        auto* file = static_cast<OIIO::TextureSystem::TextureHandle*>(q.file);
        OIIO::TextureOpt opt = options_of(q);
        bool good = true;
        for (int lane = 0; lane < PERIGEE_TEXTURE_LANES; ++lane) {
            if ((q.mask >> lane & 1U) == 0) {
                continue;
            }
            float value[4] = {}, by_s[4] = {}, by_t[4] = {};
            opt.sblur = q.sblur[lane];
            opt.tblur = q.tblur[lane];
            const bool slopes = q.by_s != nullptr;
            good &= ts.texture(file, thread, opt, q.s[lane], q.t[lane], q.dsdu[lane], q.dtdu[lane],
                               q.dsdv[lane], q.dtdv[lane], q.num_channels, value,
                               slopes ? by_s : nullptr, slopes ? by_t : nullptr);
            for (int k = 0; k < q.num_channels; ++k) {
                q.result[k * PERIGEE_TEXTURE_LANES + lane] = value[k];
            }
            if (slopes) {
                q.by_s[lane] = by_s[0];
                q.by_t[lane] = by_t[0];
            }
        }
        if (!good) {
            error(ts.geterror());
        }
        return good ? 1 : 0;
    });
}

void stats(void* system, perigee_texture_stats* out) {
    guarded<int>({nullptr, 0}, 0, [&] {
        long long held = 0, read = 0;
        system_of(system).getattribute("stat:cache_memory_used", OIIO::TypeDesc::INT64, &held);
        system_of(system).getattribute("stat:bytes_read", OIIO::TypeDesc::INT64, &read);
        out->tile_bytes = static_cast<std::uint64_t>(held);
        out->bytes_read = static_cast<std::uint64_t>(read);
        return 0;
    });
}

// --- whole pictures

int read(const char* path, std::size_t max_values, perigee_pixels* out, char* text,
         std::size_t size) {
    const Error error{text, size};
    return guarded<int>(error, 0, [&] {
        *out = {};
        const std::unique_ptr<OIIO::ImageInput> in = OIIO::ImageInput::open(path);
        if (!in) {
            error(OIIO::geterror());
            return 0;
        }
        const OIIO::ImageSpec& spec = in->spec();
        const auto values = static_cast<std::uint64_t>(spec.width) *
                            static_cast<std::uint64_t>(spec.height) *
                            static_cast<std::uint64_t>(spec.nchannels);
        if (!size_problem(spec).empty() || values > max_values) {
            error(size_problem(spec).empty() ? "it is too large" : size_problem(spec));
            return 0;
        }
        std::unique_ptr<float[]> pixels(new float[values]);
        if (!in->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, pixels.get())) {
            error(in->geterror());
            return 0;
        }
        *out = {spec.width, spec.height, spec.nchannels, pixels.release()};
        return 1;
    });
}

void free_pixels(perigee_pixels* pixels) {
    delete[] pixels->values;
    *pixels = {};
}

OIIO::ImageSpec make_config(const perigee_make& what) {
    OIIO::ImageSpec config;
    config.attribute("wrapmodes", std::string(what.smode) + "," + what.tmode);
    config.attribute("maketx:filtername", what.filter);
    config.attribute("maketx:resize", what.resize);
    config.attribute("maketx:nomipmap", what.mipmap != 0 ? 0 : 1);
    config.attribute("maketx:hash", 0);
    config.attribute("maketx:compute_average", 0);
    config.attribute("maketx:fileformatname", "tiff");
    config.attribute("Software", "Perigee");
    config.attribute("compression", what.compression);
    if (what.format[0] != '\0') {
        config.set_format(OIIO::TypeDesc(what.format));
    }
    config.tile_width = config.tile_height = autotile_px;
    config.tile_depth = 1;
    return config;
}

bool make_file(const perigee_make& what, const std::string& name, std::string& why) {
    const OIIO::ImageBufAlgo::MakeTextureMode mode = std::strcmp(what.kind, "latlong") == 0
                                                         ? OIIO::ImageBufAlgo::MakeTxEnvLatl
                                                         : OIIO::ImageBufAlgo::MakeTxTexture;
    std::ostringstream said;
    bool good = false;
    if (what.pixels != nullptr) {
        const perigee_pixels& p = *what.pixels;
        OIIO::ImageBuf buffer(
            OIIO::ImageSpec(p.width, p.height, p.num_channels, OIIO::TypeDesc::FLOAT), p.values);
        good = OIIO::ImageBufAlgo::make_texture(mode, buffer, name, make_config(what), &said);
    } else {
        good = OIIO::ImageBufAlgo::make_texture(mode, what.picture, name, make_config(what), &said);
    }
    why = OIIO::geterror();
    why = why.empty() ? said.str() : why;
    while (!why.empty() && why.back() == '\n') {
        why.pop_back();
    }
    return good;
}

bool copy_file(const std::string& name, perigee_byte_sink sink, void* user) {
    std::ifstream file(name, std::ios::binary);
    std::vector<char> block(1 << 16);
    while (file.read(block.data(), static_cast<std::streamsize>(block.size())) ||
           file.gcount() > 0) {
        if (sink(user, block.data(), static_cast<std::size_t>(file.gcount())) == 0) {
            return false;
        }
    }
    return file.eof();
}

int make(const perigee_make* what, perigee_byte_sink sink, void* user, char* text,
         std::size_t size) {
    const Error error{text, size};
    return guarded<int>(error, 0, [&] {
        const base::TempDir directory("perigee");
        if (directory.path().empty()) {
            error("no temporary directory");
            return 0;
        }
        OIIO::attribute("threads", 1); // the bytes repeat
        const std::string name = directory.path() + "/texture.tif";
        std::string why;
        if (!make_file(*what, name, why)) {
            error(why.empty() ? "OpenImageIO cannot make it" : why);
            return 0;
        }
        if (!copy_file(name, sink, user)) {
            error("it cannot be written");
            return 0;
        }
        return 1;
    });
}

} // namespace

extern "C" __attribute__((visibility("default"))) const perigee_textures*
perigee_oiio_textures(void) {
    static constexpr perigee_textures table = {create, destroy, set_memory, open,        invalidate,
                                               lookup, stats,   read,       free_pixels, make};
    return &table;
}
