// SPDX-License-Identifier: Apache-2.0
#include "runtime/shader_finder.h"

#include "runtime/base/file.h"
#include "runtime/base/seal.h"
#include "sl_fingerprint.h"

#include <filesystem>
#include <sys/stat.h>

namespace rt {

namespace {

namespace fs = std::filesystem;

bool is_file(const std::string& path) {
    struct stat info {};
    return ::stat(path.c_str(), &info) == 0 && S_ISREG(info.st_mode);
}

std::string canonical(const std::string& path) {
    std::error_code error;
    const fs::path real = fs::weakly_canonical(path.empty() ? "." : path, error);
    return error ? path : real.lexically_normal().string();
}

// Objects may carry another renderer's suffix (slc -o x.slc); that renderer's own objects are no
// concern of ours.
std::string object_at(const std::string& stem) {
    if (is_file(stem + ".slo")) {
        return stem + ".slo";
    }
    for (const char* suffix : {".slc", ".slx"}) {
        const auto bytes = is_file(stem + suffix) ? base::read_file(stem + suffix) : std::nullopt;
        if (bytes && base::check_seal(*bytes, SL_ABI_FINGERPRINT) != base::SealState::Missing) {
            return stem + suffix;
        }
    }
    return "";
}

void report_untrusted(const std::string& object, base::SourcePos pos, base::Diag& diag) {
    diag.report_once("untrusted " + object, base::Severity::Warning, base::Code::NoShader, pos,
                     object + " is not loaded: compiled shaders come only from directories and "
                              "packages given by -shaders or SHADERS (--allow-programs trusts "
                              "the RIB)");
}

std::string joined(std::span<const std::string> path) {
    std::string text;
    for (const std::string& directory : path) {
        text += (text.empty() ? "" : ":") + directory;
    }
    return text;
}

} // namespace

std::string shader_stem(std::string_view name) {
    for (const std::string_view suffix : {".sl", ".slo", ".slc", ".slx"}) {
        if (name.ends_with(suffix)) {
            return std::string(name.substr(0, name.size() - suffix.size()));
        }
    }
    return std::string(name);
}

ShaderFinder::ShaderFinder(std::span<const std::string> trusted, bool trust_all)
    : trust_all_(trust_all) {
    for (const std::string& place : trusted) {
        trusted_.insert(canonical(place));
    }
}

const ShaderFinder::Element& ShaderFinder::element(const std::string& directory,
                                                   base::SourcePos pos, base::Diag& diag) {
    if (const auto it = elements_.find(directory); it != elements_.end()) {
        return it->second;
    }
    Element made;
    const std::string real = canonical(directory);
    made.is_trusted = trust_all_ || trusted_.contains(real);
    if (is_file(real)) {
        made.is_trusted |= trusted_.contains(fs::path(real).parent_path().string());
        std::string why;
        made.package = base::ArFile::open(real, why);
        if (!made.package) {
            diag.report_once("element " + real, base::Severity::Warning, base::Code::BadFile, pos,
                             directory +
                                 " on the shader path is neither a directory nor a package "
                                 "of shaders: it " +
                                 why);
        }
    }
    return elements_.emplace(directory, std::move(made)).first->second;
}

ShaderPlace ShaderFinder::look(const std::string& directory, const std::string& leaf,
                               base::SourcePos pos, base::Diag& diag) {
    ShaderPlace place;
    const Element& here = element(directory, pos, diag);
    if (here.package) {
        if (here.package->contains(leaf + ".slo")) {
            place.member = leaf + ".slo";
            if (here.is_trusted) {
                place.package = here.package.get();
            } else {
                report_untrusted(directory + "(" + place.member + ")", pos, diag);
            }
        }
        return place;
    }
    const std::string stem = directory + "/" + leaf;
    place.object = object_at(stem);
    if (!place.object.empty() && !here.is_trusted) {
        report_untrusted(place.object, pos, diag);
        place.object.clear();
    }
    if (is_file(stem + ".sl")) {
        place.source = stem + ".sl";
    }
    return place;
}

ShaderPlace ShaderFinder::find(const std::string& stem, std::span<const std::string> path,
                               base::SourcePos pos, base::Diag& diag) {
    const std::size_t slash = stem.rfind('/');
    if (slash != std::string::npos) {
        ShaderPlace place =
            look(slash == 0 ? "/" : stem.substr(0, slash), stem.substr(slash + 1), pos, diag);
        if (!place.is_empty()) {
            return place;
        }
    } else {
        for (const std::string& directory : path) {
            ShaderPlace place = look(directory.empty() ? "." : directory, stem, pos, diag);
            if (!place.is_empty()) {
                return place;
            }
        }
    }
    diag.report(base::Severity::Error, base::Code::NoShader, pos,
                "no shader \"" + stem + "\" (" + stem + ".slo or " + stem + ".sl)" +
                    (slash == std::string::npos ? " on the path " + joined(path) : ""));
    return {};
}

} // namespace rt
