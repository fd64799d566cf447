// SPDX-License-Identifier: Apache-2.0
// The graphics state (ri.md 1.2 and sections 5 to 8, 12): requests enter in order, finished scenes
// leave to the Backend.
//
// Every request of ri_requests.def has a body do_<name>; a missing one is a link error. Attributes
// and transformations are values that blocks save; they are copied into the scene only when a
// primitive, light or shader needs them and they have changed since (freeze_*), so equal states
// share one record.
#pragma once

#include "ribtools/backend.h"
#include "ribtools/blocks.h"
#include "ribtools/reader.h"
#include "ribtools/request.h"
#include "ribtools/rib_parse.h"
#include "ribtools/scene.h"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

namespace rib {

// What the state asks of whoever feeds it: requests about the stream itself.
class StreamHost {
public:
    virtual ~StreamHost() = default;
    virtual void read_archive(const std::string& name, base::SourcePos pos) = 0;
    virtual void begin_archive(const std::string& name, base::SourcePos pos) = 0;
    virtual void conditional(const Request& request) = 0;
    virtual void
    forget_archives(std::size_t keep) = 0; // those defined last, at the end of a frame or world
    [[nodiscard]] virtual std::size_t num_archives() const = 0;
};

class State {
public:
    State(Backend& backend, base::Diag& diag, const Config& config, StreamHost& host);
    ~State();
    State(const State&) = delete;
    State& operator=(const State&) = delete;

    // Checks that the request is legal here and carries it out. Takes what it can from the request.
    void execute(Request& request);
    // The stream has ended: blocks opened in it are closed with a message, an unfinished world is
    // dropped. tell: false where a message about the end itself has said enough.
    void close_blocks(base::SourcePos end, std::size_t keep, bool tell);
    [[nodiscard]] std::size_t depth() const { return blocks_.depth(); }
    // The backend returned false or the error handler asks to end the run.
    [[nodiscard]] bool stopped() const;
    // What ended one stream does not end the next.
    void restart();

    [[nodiscard]] const Dictionary& dictionary() const { return dictionary_; }
    [[nodiscard]] const ColorModel& colors() const { return colors_; }
    [[nodiscard]] const Options& options() const { return options_; }
    [[nodiscard]] const Attributes& attributes() const { return attributes_.value; }

private:
    // A value and the scene record it equals, none if it changed since it was last needed there.
    template <class T> struct Frozen {
        T value;
        std::uint32_t id = none;
    };
    struct Saved;        // what a block restores
    struct ObjectRecord; // what instancing needs to know besides the Object
    struct Edit;         // an attribute request inside an object

#define RI_REQUEST(name, ...) void do_##name(Request& request);
#include "ribtools/ri_requests.def"
    using Body = void (State::*)(Request&);
    static const Body bodies[];

    void dispatch(Request& request) {
        (this->*bodies[static_cast<std::size_t>(request.id)])(request);
    }
    [[nodiscard]] bool admit(const Request& request);
    [[nodiscard]] bool refuse_depth(const Request& request);

    // --- messages ---
    void report(base::Severity severity, base::Code code, const Request& request,
                const std::string& text);
    void error(base::Code code, const Request& request, const std::string& text) {
        report(base::Severity::Error, code, request, text);
    }
    void warn(base::Code code, const Request& request, const std::string& text) {
        report(base::Severity::Warning, code, request, text);
    }
    void warn_once(const std::string& key, base::Code code, const Request& request,
                   const std::string& text);

    // --- blocks ---
    void open(BlockKind kind, const Request& request);
    // Closes the innermost block of this kind, with a message unwinding what overlaps it. False:
    // there is none.
    bool close(BlockKind kind, const Request& request);
    void restore(BlockKind kind);
    void end_world(bool render);
    void resolve_options();
    void declare_outputs(Options& o) const;
    void bring_into_world();

    // --- shared records ---
    [[nodiscard]] std::uint32_t freeze_attributes();
    [[nodiscard]] TransformId freeze_transform();
    [[nodiscard]] TransformId add_transform(const Transform& t);
    [[nodiscard]] ShaderId add_shader(std::string name, ParamList params, TransformId space,
                                      base::SourcePos pos, ShaderRole role);
    void announce(const ShaderCall& call, ShaderRole role);
    [[nodiscard]] Shared<std::vector<std::string>> shader_path();
    void forget_indices();
    Attributes& edit_attributes();

    // --- transformations ---
    [[nodiscard]] std::optional<base::Mat4> matrix_of(const Request& request);
    void transform(const Request& request);
    void set_transform(Transform t, const Request& request);
    void move_transform(std::span<Request> samples, std::span<const float> times);
    [[nodiscard]] std::optional<Transform> named_system(const std::string& name) const;
    [[nodiscard]] base::Mat4 camera_from_current() const;

    // --- shaders and lights ---
    ShaderId shader_attribute(Request& request, ShaderRole role);
    LightId add_light(Request& request, bool is_area);
    void set_color(std::array<float, 3>& target, const Request& request);

    // --- options ---
    void check_option_name(OptionCategory category, const Request& request, const Param& param);
    void set_search_path(const Param& param);
    std::optional<std::array<float, 4>> four(const Request& request);

    // --- primitives ---
    void emit(Shape shape, Request& request);
    void store(Primitive primitive);
    void quadric(Request& request, QuadricKind kind, int num_args);
    void polygons(Request& request, std::vector<std::int32_t> num_loops,
                  std::vector<std::int32_t> num_vertices, std::vector<std::int32_t> vertices);
    void subdivision_mesh(Request& request, bool hierarchical);
    void move_geometry(std::span<Request> samples, std::span<const float> times);
    [[nodiscard]] std::uint32_t solid_for_geometry();
    void make_texture(Request& request);

    // --- objects ---
    struct InstanceSite;
    void instantiate(std::uint32_t object, const InstanceSite& site, const Request& request,
                     int depth, std::size_t& budget);
    void become_primitives(const Instance& instance, const InstanceSite& site);
    [[nodiscard]] std::uint32_t replay(const ObjectRecord& record, std::uint32_t edit,
                                       const Attributes& start, const Transform& place);
    void finish_object();

    Backend& backend_;
    base::Diag& diag_;
    const Config& config_;
    StreamHost& host_;
    Dictionary dictionary_;
    ColorModel colors_;
    Options options_;
    Shared<std::vector<std::string>> shader_path_; // of the last call
    Frozen<Attributes> attributes_;
    // World-from-current inside a world, camera-from-current before it, definition-from-current in
    // an object.
    Frozen<Transform> transform_;
    base::Mat4 screen_from_camera_extra_;
    std::unique_ptr<Scene>
        scene_; // grows until WorldEnd; before WorldBegin: what the next world starts with
    Blocks blocks_;
    std::vector<std::unique_ptr<Saved>> saved_; // one per open block
    std::unordered_map<std::string, LightId> light_handles_;
    std::unordered_map<std::string, std::uint32_t> object_handles_;
    std::unordered_map<std::string, Frozen<Attributes>> resources_;
    std::unordered_multimap<std::size_t, std::uint32_t> attribute_index_, shader_index_,
        transform_index_; // by hash, into the scene's records
    std::vector<float> motion_times_;
    std::vector<Request> motion_samples_;
    std::vector<Primitive>* motion_sink_ =
        nullptr; // where emit() leaves samples of moving geometry
    std::vector<std::shared_ptr<ObjectRecord>> objects_; // parallel to Scene::objects
    ObjectRecord* open_object_ = nullptr;
    std::uint32_t current_edit_ = none;
    base::Mat4 object_base_; // transformation at ObjectBegin, for handedness
    std::uint32_t current_solid_ = none;
    std::unordered_map<std::uint32_t, int> solid_operands_; // of the scene's solids
    std::size_t refused_blocks_ = 0;
    bool world_wanted_ = true;
    bool replaying_ = false; // messages were given when the object was defined
    bool stop_ = false;
};

} // namespace rib
