// SPDX-License-Identifier: Apache-2.0
// State: dispatch, legality, messages, and the records that primitives share.
#include "ribtools/state.h"

#include "ribtools/search_path.h"
#include "ribtools/state_impl.h"

#include <functional>

namespace rib {

namespace {

void mix(std::size_t& hash, std::size_t value) {
    hash ^= value + 0x9e3779b97f4a7c15ull + (hash << 6) + (hash >> 2);
}

template <class T> void mix_all(std::size_t& hash, const T& values) {
    for (const auto& value : values) {
        mix(hash, std::hash<std::decay_t<decltype(value)>>{}(value));
    }
}

void mix_param(std::size_t& hash, const Param& p) {
    mix(hash, std::hash<std::string>{}(p.name));
    mix_all(hash, p.floats);
    mix_all(hash, p.ints);
    mix_all(hash, p.strings);
}

std::size_t hash_of(const Attributes& a) {
    std::size_t hash = 0;
    mix_all(hash, a.color);
    mix_all(hash, a.opacity);
    for (const std::uint32_t id :
         {a.surface, a.displacement, a.atmosphere, a.interior, a.exterior, a.area_light}) {
        mix(hash, id);
    }
    mix_all(hash, a.lights);
    mix(hash, static_cast<std::size_t>(a.matte * 8 + a.sides * 2 + a.orientation_matches));
    mix(hash, std::hash<float>{}(a.shading_rate));
    for (const auto& [name, param] : a.user) {
        mix_param(hash, param);
    }
    return hash;
}

std::size_t hash_of(const Transform& t) {
    std::size_t hash = 0;
    for (const Transform::Key& key : t.keys) {
        mix(hash, std::hash<float>{}(key.time));
        for (const auto& matrix_row : key.m.m) {
            mix_all(hash, matrix_row);
        }
    }
    return hash;
}

std::size_t hash_of(const std::string& name, const ParamList& params) {
    std::size_t hash = std::hash<std::string>{}(name);
    for (const Param& p : params.params) {
        mix_param(hash, p);
    }
    return hash;
}

// Records with one hash value are compared up to this many; beyond, a duplicate costs less than the
// search.
constexpr int max_candidates = 16;

} // namespace

const State::Body State::bodies[] = {
#define RI_REQUEST(name, ...) &State::do_##name,
#include "ribtools/ri_requests.def"
};

State::State(Backend& backend, base::Diag& diag, const Config& config, StreamHost& host)
    : backend_(backend), diag_(diag), config_(config), host_(host), options_(config.defaults),
      scene_(std::make_unique<Scene>()) {
    for (const auto& [name, directories] : config.default_paths) {
        options_.search_paths.try_emplace(name, directories);
    }
}

State::~State() = default;

bool State::stopped() const {
    return stop_ || diag_.abort_requested();
}

void State::restart() {
    stop_ = false;
    diag_.clear_abort();
}

// --- messages ---

void State::report(base::Severity severity, base::Code code, const Request& request,
                   const std::string& text) {
    if (!replaying_) {
        const std::string whole = std::string(row(request.id).name) + ": " + text;
        diag_.report_few(base::kind_of(whole), base::max_alike, severity, code, request.pos, whole);
    }
}

void State::warn_once(const std::string& key, base::Code code, const Request& request,
                      const std::string& text) {
    diag_.report_once(key, base::Severity::Warning, code, request.pos,
                      std::string(row(request.id).name) + ": " + text);
}

// --- legality and dispatch ---

bool State::admit(const Request& request) {
    const RequestRow& r = row(request.id);
    if (blocks_.is_legal(r)) {
        return true;
    }
    const BlockKind inner = blocks_.innermost();
    if (inner == BlockKind::Motion) {
        error(base::Code::BadMotion, request, "may not stand in a motion block; skipped");
        return false;
    }
    const bool begins_picture = r.block == BlockKind::World || r.block == BlockKind::Frame;
    const bool harmless = inner == BlockKind::Attribute || inner == BlockKind::Transform;
    if (begins_picture && r.effect == BlockEffect::Open && harmless &&
        !blocks_.inside(BlockKind::World) && !blocks_.inside(BlockKind::Object)) {
        warn(base::Code::Nesting, request, "not legal " + blocks_.where(r) + "; accepted");
        return true;
    }
    error(illegal_code(r.kind), request, "not legal " + blocks_.where(r) + "; skipped");
    return false;
}

// Blocks beyond the limit are counted instead of opened, and their ends are taken from that count.
bool State::refuse_depth(const Request& request) {
    const BlockEffect effect = row(request.id).effect;
    if (effect == BlockEffect::Close && refused_blocks_ > 0) {
        --refused_blocks_;
        return true;
    }
    if (effect != BlockEffect::Open || blocks_.depth() < Blocks::max_depth) {
        return false;
    }
    if (refused_blocks_++ == 0) {
        error(base::Code::Limit, request,
              "more than " + std::to_string(Blocks::max_depth) + " nested blocks; ignored");
    }
    return true;
}

void State::execute(Request& request) {
    const RequestRow& r = row(request.id);
    if (blocks_.innermost() == BlockKind::Motion && r.motion == MotionAbility::Moves) {
        motion_samples_.push_back(std::move(request));
        request = Request();
        return;
    }
    if (refuse_depth(request) || !admit(request)) {
        return;
    }
    if (open_object_ && r.kind == RequestKind::Attribute && request.id != RequestId::Basis &&
        request.id != RequestId::TrimCurve) {
        open_object_->edits.push_back({current_edit_, request, transform_.value});
        current_edit_ = static_cast<std::uint32_t>(open_object_->edits.size() - 1);
    }
    dispatch(request);
}

// --- shared records ---

Attributes& State::edit_attributes() {
    attributes_.id = none;
    return attributes_.value;
}

std::uint32_t State::freeze_attributes() {
    if (attributes_.id != none) {
        return attributes_.id;
    }
    const std::size_t hash = hash_of(attributes_.value);
    auto [it, end] = attribute_index_.equal_range(hash);
    for (int i = 0; it != end && i < max_candidates; ++it, ++i) {
        if (scene_->attributes[it->second] == attributes_.value) {
            return attributes_.id = it->second;
        }
    }
    attributes_.id = static_cast<std::uint32_t>(scene_->attributes.size());
    scene_->attributes.push_back(attributes_.value);
    attribute_index_.emplace(hash, attributes_.id);
    return attributes_.id;
}

TransformId State::add_transform(const Transform& t) {
    const std::size_t hash = hash_of(t);
    auto [it, end] = transform_index_.equal_range(hash);
    for (int i = 0; it != end && i < max_candidates; ++it, ++i) {
        if (scene_->transforms[it->second].keys == t.keys) {
            return it->second;
        }
    }
    const auto id = static_cast<TransformId>(scene_->transforms.size());
    scene_->transforms.push_back(t);
    transform_index_.emplace(hash, id);
    return id;
}

TransformId State::freeze_transform() {
    if (transform_.id == none) {
        transform_.id = add_transform(transform_.value);
    }
    return transform_.id;
}

// Calls share one path until it changes.
Shared<std::vector<std::string>> State::shader_path() {
    std::vector<std::string> path = search_directories(options_, "shader");
    if (path != *shader_path_) {
        shader_path_ = std::move(path);
    }
    return shader_path_;
}

void State::announce(const ShaderCall& call, ShaderRole role) {
    const bool in_world = blocks_.inside(BlockKind::World);
    const bool is_wanted =
        in_world ? world_wanted_
                 : !options_.in_frame || !config_.wants_world || config_.wants_world(options_);
    if (is_wanted) {
        backend_.shader_named(call, role);
    }
}

ShaderId State::add_shader(std::string name, ParamList params, TransformId space,
                           base::SourcePos pos, ShaderRole role) {
    const std::size_t hash = hash_of(name, params);
    const Shared<std::vector<std::string>> path = shader_path();
    ShaderId first = none;
    auto [it, end] = shader_index_.equal_range(hash);
    for (int i = 0; it != end && i < max_candidates; ++it, ++i) {
        const ShaderCall& call = scene_->shaders[it->second];
        if (call.name == name && call.params == params && call.search_path == path) {
            if (call.world_from_shader == space) {
                return it->second;
            }
            first = call.same_params_as;
        }
    }
    const auto id = static_cast<ShaderId>(scene_->shaders.size());
    ShaderCall call;
    call.name = std::move(name);
    call.params = std::move(params);
    call.search_path = path;
    call.world_from_shader = space;
    call.same_params_as = first == none ? id : first;
    call.pos = pos;
    announce(call, role);
    scene_->shaders.push_back(std::move(call));
    shader_index_.emplace(hash, id);
    return id;
}

// The scene was exchanged: indices into the old one mean nothing now.
void State::forget_indices() {
    attribute_index_.clear();
    shader_index_.clear();
    transform_index_.clear();
}

// --- bookkeeping requests (ri.md 6.1) ---

void State::do_version(Request& request) {
    constexpr double newest = 3.04; // later than this, requests may be unknown
    if (request.number(0) > newest + 0.0001) {
        warn_once("version", base::Code::Version, request, "later than 3.04; read all the same");
    }
}

void State::do_Declare(Request& request) {
    const std::string& name = request.string(0);
    const std::string& text = request.string(1);
    if (text.find_first_not_of(" \t\r\n\f\v") == std::string::npos) {
        dictionary_.remove(name);
        return;
    }
    const Declaration d = parse_declaration(text);
    const Dictionary::Entry* old = dictionary_.find(name);
    if (!d.error.empty()) {
        diag_.report_once("declare:" + name + ":" + text, base::Severity::Error, base::Code::Syntax,
                          request.pos,
                          "Declare: " + quoted(name) + " " + quoted(text) + ": " + d.error +
                              "; values of this name are skipped");
        dictionary_.set(name, {{}, false, true});
        return;
    }
    if (old && old->predeclared && (old->decl.type != d.decl.type)) {
        warn(base::Code::Consistency, request,
             quoted(name) + " is predeclared as " + quoted(declaration_text(old->decl)) + "; now " +
                 quoted(declaration_text(d.decl)));
    }
    dictionary_.set(name, {d.decl, false, false});
}

void State::do_ErrorHandler(Request& request) {
    const std::string& name = request.string(0);
    if (name == "ignore" || name == "print" || name == "abort") {
        diag_.set_handler(name == "ignore"  ? base::ErrorHandler::Ignore
                          : name == "print" ? base::ErrorHandler::Print
                                            : base::ErrorHandler::Abort);
    } else {
        error(base::Code::BadToken, request,
              "unknown handler " + quoted(name) + " (ignore, print, abort); unchanged");
    }
}

void State::do_ArchiveRecord(Request&) {} // a comment by another name

void State::do_System(Request& request) {
    warn_once("System", base::Code::Incapable, request, "programs are not run; ignored");
}

} // namespace rib
