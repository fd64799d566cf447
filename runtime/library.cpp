// SPDX-License-Identifier: Apache-2.0
// Finding shaders: a name becomes a file on the search path, a compiled object or an .sl compiled
// into the user's cache, and is remembered whether it was found or not. One lock for all of it:
// shaders are looked up while a scene is read, not while it is shaded.
#include "runtime/base/file.h"
#include "runtime/base/seal.h"
#include "runtime/base/sha256.h"
#include "runtime/shader.h"
#include "sl_fingerprint.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <sys/stat.h>
#include <unistd.h>

namespace rt {

namespace {

namespace fs = std::filesystem;

std::string strip_suffix(std::string_view name) {
    for (const std::string_view suffix : {".sl", ".slo", ".slc", ".slx"}) {
        if (name.ends_with(suffix)) {
            return std::string(name.substr(0, name.size() - suffix.size()));
        }
    }
    return std::string(name);
}

bool is_file(const std::string& path) {
    struct stat info {};
    return ::stat(path.c_str(), &info) == 0 && S_ISREG(info.st_mode);
}

constexpr const char* type_names[] = {"surface", "displacement", "light",
                                      "volume",  "imager",       "transformation"};

std::string shader_type_text(int type) {
    return type >= 0 && type <= SL_SHADER_transformation ? type_names[type] : "unknown";
}

} // namespace

std::string default_cache_dir() {
    const auto variable = [](const char* name) {
        const char* value = std::getenv(name);
        return std::string(value ? value : "");
    };
    if (const std::string own = variable("PERIGEE_CACHE"); !own.empty()) {
        return own;
    }
    if (const std::string xdg = variable("XDG_CACHE_HOME"); !xdg.empty()) {
        return xdg + "/perigee";
    }
    const std::string home = variable("HOME");
    return home.empty() ? "" : home + "/.cache/perigee";
}

struct ShaderLibrary::Impl {
    Config config;
    StringTable& strings;
    base::Diag& diag;
    std::mutex mutex;
    std::map<std::string, std::unique_ptr<ShaderObject>, std::less<>> by_path;
    std::vector<std::unique_ptr<ShaderObject>> adopted;
    std::map<std::string, const ShaderObject*, std::less<>>
        by_name;             // nullptr: known to be missing or broken
    std::string scratch_dir; // made when there is no cache

    ~Impl() {
        by_name.clear();
        by_path.clear();
        if (!scratch_dir.empty()) {
            std::error_code ignored;
            fs::remove_all(scratch_dir, ignored);
        }
    }

    const ShaderObject* open(const std::string& path, std::string& why) {
        if (const auto it = by_path.find(path); it != by_path.end()) {
            return it->second.get();
        }
        auto object = ShaderObject::open(path, strings, why);
        const ShaderObject* result = object.get();
        if (object) {
            by_path.emplace(path, std::move(object));
        }
        return result;
    }

    // A directory to compile into: the cache, or one that goes with this library.
    std::string object_dir() {
        std::error_code error;
        if (!config.cache_dir.empty()) {
            fs::create_directories(config.cache_dir, error);
            if (!error && ::access(config.cache_dir.c_str(), W_OK) == 0) {
                return config.cache_dir;
            }
            diag.report_once("shader cache", base::Severity::Warning, base::Code::System, {},
                             "shader cache " + config.cache_dir +
                                 " cannot be written; shaders are compiled for this run only");
        }
        if (scratch_dir.empty()) {
            std::string pattern = (fs::temp_directory_path(error) / "perigee-XXXXXX").string();
            if (::mkdtemp(pattern.data())) {
                scratch_dir = pattern;
            }
        }
        return scratch_dir;
    }

    const ShaderObject* open_source(const std::string& sl_path) {
        if (!config.compile || !config.cache_key) {
            diag.report_once("no compiler " + sl_path, base::Severity::Error, base::Code::NoShader,
                             {}, sl_path + " is not compiled, and this program cannot compile it");
            return nullptr;
        }
        const auto key = config.cache_key(sl_path, diag);
        const std::string dir = key ? object_dir() : std::string();
        if (dir.empty()) {
            return nullptr;
        }
        const std::string name = base::sha256_hex(*key);
        const std::string folder = dir + "/" + name.substr(0, 2);
        std::error_code error;
        fs::create_directories(folder, error);
        const std::string slo_path = folder + "/" + name.substr(2) + ".slo";
        std::string why;
        if (is_file(slo_path)) {
            if (const ShaderObject* object = open(slo_path, why)) {
                return object;
            }
            // A damaged entry is replaced.
        }
        if (!config.compile(sl_path, slo_path, diag)) {
            return nullptr;
        }
        const ShaderObject* object = open(slo_path, why);
        if (!object) {
            diag.report(base::Severity::Error, base::Code::NoShader, {},
                        "freshly compiled " + slo_path + " " + why);
        }
        return object;
    }

    // Objects may carry another renderer's suffix (slc -o x.slc); that renderer's own objects are
    // no concern of ours.
    static std::string canonical(const std::string& directory) {
        std::error_code error;
        const auto path =
            std::filesystem::weakly_canonical(directory.empty() ? "." : directory, error);
        return error ? directory : path.lexically_normal().string();
    }
    static std::string canonical_directory(const std::string& stem) {
        return canonical(std::filesystem::path(stem).parent_path().string());
    }

    static std::string object_at(const std::string& stem) {
        if (is_file(stem + ".slo")) {
            return stem + ".slo";
        }
        for (const char* suffix : {".slc", ".slx"}) {
            const auto bytes = base::read_file(stem + suffix);
            if (bytes && base::check_seal(*bytes, SL_ABI_FINGERPRINT) != base::SealState::Missing) {
                return stem + suffix;
            }
        }
        return "";
    }

    [[nodiscard]] bool is_trusted(const std::string& stem) const {
        const std::string directory = canonical_directory(stem);
        return config.trust_all ||
               std::any_of(config.trusted.begin(), config.trusted.end(),
                           [&](const std::string& t) { return canonical(t) == directory; });
    }

    // In one directory (or at a path without suffix): the object, else its source.
    const ShaderObject* open_at(const std::string& stem, base::SourcePos pos, bool& exists) {
        std::string object_path = object_at(stem);
        if (!object_path.empty() && !is_trusted(stem)) {
            diag.report_once("untrusted " + object_path, base::Severity::Warning,
                             base::Code::NoShader, pos,
                             object_path + " is not loaded: compiled shaders come only from "
                                           "directories given by -shaders or SHADERS "
                                           "(--allow-programs trusts the RIB)");
            object_path.clear();
        }
        const std::string source_path = stem + ".sl";
        const bool has_source = is_file(source_path);
        if (!object_path.empty()) {
            exists = true;
            std::string why;
            if (const ShaderObject* object = open(object_path, why)) {
                return object;
            }
            const bool rescue = has_source && config.compile;
            diag.report_once("slo " + object_path,
                             rescue ? base::Severity::Warning : base::Severity::Error,
                             base::Code::NoShader, pos,
                             object_path + " " + why +
                                 (rescue ? "; " + source_path + " is compiled instead" : ""));
            return rescue ? open_source(source_path) : nullptr;
        }
        if (has_source) {
            exists = true;
            return open_source(source_path);
        }
        return nullptr;
    }

    const ShaderObject* search(const std::string& stem, base::SourcePos pos) {
        bool exists = false;
        const ShaderObject* found = nullptr;
        if (stem.find('/') != std::string::npos) {
            found = open_at(stem, pos, exists);
        } else {
            for (const std::string& dir : config.search_path) {
                found = open_at((dir.empty() ? "." : dir) + "/" + stem, pos, exists);
                if (exists) {
                    break;
                }
            }
        }
        if (!found && !exists) {
            std::string path;
            for (const std::string& dir : config.search_path) {
                path += (path.empty() ? "" : ":") + dir;
            }
            diag.report(base::Severity::Error, base::Code::NoShader, pos,
                        "no shader \"" + stem + "\" (" + stem + ".slo or " + stem + ".sl)" +
                            (stem.find('/') == std::string::npos ? " on the path " + path : ""));
        }
        return found;
    }
};

ShaderLibrary::ShaderLibrary(Config config, StringTable& strings, base::Diag& diag)
    : impl_(new Impl{std::move(config), strings, diag, {}, {}, {}, {}, {}}), strings_(strings) {}

ShaderLibrary::~ShaderLibrary() = default;

const ShaderObject* ShaderLibrary::find(std::string_view name, sl_shader_type wanted,
                                        base::SourcePos pos) {
    const ShaderObject* found = find_any(name, pos);
    if (found && found->object().type != wanted) {
        const std::string stem = strip_suffix(name);
        impl_->diag.report_once("shader type " + stem + shader_type_text(wanted),
                                base::Severity::Error, base::Code::NoShader, pos,
                                "shader \"" + stem + "\" is a " +
                                    shader_type_text(found->object().type) + " shader, not a " +
                                    shader_type_text(wanted) + " shader");
        return nullptr;
    }
    return found;
}

const ShaderObject* ShaderLibrary::find_any(std::string_view name, base::SourcePos pos) {
    const std::string stem = strip_suffix(name);
    const std::lock_guard lock(impl_->mutex);
    auto it = impl_->by_name.find(stem);
    if (it == impl_->by_name.end()) {
        it = impl_->by_name.emplace(stem, impl_->search(stem, pos)).first;
    }
    return it->second;
}

const ShaderObject* ShaderLibrary::load(const std::string& slo_path, base::SourcePos pos) {
    const std::lock_guard lock(impl_->mutex);
    std::string why;
    const ShaderObject* object = impl_->open(slo_path, why);
    if (!object) {
        impl_->diag.report(base::Severity::Error, base::Code::NoShader, pos, slo_path + " " + why);
    }
    return object;
}

const ShaderObject* ShaderLibrary::adopt(const sl_object& object) {
    const std::lock_guard lock(impl_->mutex);
    std::string why;
    auto shader = ShaderObject::adopt(object, strings_, why);
    if (!shader) {
        impl_->diag.report(base::Severity::Error, base::Code::Bug, {},
                           "built-in shader object " + why);
        return nullptr;
    }
    const ShaderObject* adopted = impl_->adopted.emplace_back(std::move(shader)).get();
    impl_->by_name.insert_or_assign(object.name, adopted);
    return adopted;
}

} // namespace rt
