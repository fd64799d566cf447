// SPDX-License-Identifier: Apache-2.0
// Compiled shaders as the engine uses them: found on a search path, loaded once, instanced with
// bound parameters.
//
// ShaderLibrary owns objects for a whole run and is safe from any thread; objects stay loaded until
// it goes. Where only `name.sl` is found it is compiled, once, through the compile function it was
// given (the runtime does not know slc), and kept in the user's cache.
#pragma once

#include "runtime/abi/sl_abi.h"
#include "runtime/base/descriptor.h"
#include "runtime/base/diag.h"
#include "runtime/shader_cache.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

namespace rt {

// Strings of a run: equal texts share one pointer (sl_string). Safe from any thread; pointers live
// as long as the table.
class StringTable {
public:
    // Text is taken up to its first NUL: a sl_string ends there.
    sl_string intern(std::string_view text);

private:
    struct Hash {
        using is_transparent = void;
        std::size_t operator()(std::string_view text) const {
            return std::hash<std::string_view>()(text);
        }
    };
    std::mutex mutex_;
    std::unordered_set<std::string, Hash, std::equal_to<>> texts_; // node-based: addresses stay
};

// One loaded .slo.
class ShaderObject {
public:
    // nullptr, with the reason in `why`, when the file is missing, truncated, damaged, made for
    // another ABI, or holds nothing this processor can run. Nothing in the file is executed before
    // its seal has been checked.
    static std::unique_ptr<ShaderObject> open(const std::string& slo_path, StringTable& strings,
                                              std::string& why);
    // The same for an object that is no file.
    static std::unique_ptr<ShaderObject> open_bytes(std::string_view bytes, StringTable& strings,
                                                    std::string& why);
    // The same for an object linked into the program.
    static std::unique_ptr<ShaderObject> adopt(const sl_object& object, StringTable& strings,
                                               std::string& why);
    ~ShaderObject();
    ShaderObject(const ShaderObject&) = delete;
    ShaderObject& operator=(const ShaderObject&) = delete;
    [[nodiscard]] const sl_object& object() const { return *object_; }
    // The best variant this processor can run.
    [[nodiscard]] const sl_variant& variant() const { return *variant_; }
    [[nodiscard]] const std::vector<sl_string>& strings() const { return strings_; }
    // Index of a parameter, or -1.
    [[nodiscard]] int find_param(std::string_view name) const;
    // Hash of the file's content; "" for an adopted object, which changes with the program only.
    [[nodiscard]] const std::string& content() const { return content_; }

private:
    ShaderObject() = default;
    bool link(const std::string& file, StringTable& strings, std::string& why);
    bool take(const sl_object& object, StringTable& strings, std::string& why);

    base::Descriptor memory_; // of open_bytes
    void* handle_ = nullptr;  // null for an adopted object
    const sl_object* object_ = nullptr;
    const sl_variant* variant_ = nullptr;
    std::vector<sl_string> strings_;
    std::string content_;
};

// Ends a compilation early when it returns true; may be empty.
using Cancelled = std::function<bool()>;

struct BoundValue;

// An object for one set of parameter values, which can be made.
struct SpecialShader {
    std::string key;            // of the cache
    double gain = 0;            // share of the general shader's time it saves, expected
    double compile_seconds = 0; // estimated
    std::function<std::optional<std::string>(base::Diag&, const Cancelled&)> compile;
};

// What a library did so far. Seconds are summed over threads.
struct LibraryStats {
    std::uint64_t objects = 0;      // opened
    std::uint64_t cache_hits = 0;   // sources whose object was in the cache
    std::uint64_t cache_misses = 0; // ... was not, or there is no cache
    std::uint64_t compiled = 0, compiled_special = 0;
    double search_seconds = 0; // looking for files, keys of the cache
    double compile_seconds = 0, special_seconds = 0, load_seconds = 0;
};

class ShaderLibrary {
public:
    struct Config {
        // Places to look in before and after those of a call: directories, or package files
        // (docs/shader_cache.md).
        std::vector<std::string> path_first, search_path;
        // Places whose compiled objects may be loaded: objects are machine code, so they come
        // only from places the user named, never from a path a RIB sets. Sources are compiled
        // from anywhere.
        std::vector<std::string> trusted;
        bool trust_all = false;
        std::string cache_dir; // see default_cache_dir(); "" = objects live as long as the library
        std::uint64_t cache_bytes = default_cache_bytes;
        int num_threads = 1; // that compile at a time in the background
        Cancelled interrupted;
        // Compiles an .sl file: the sealed object, or nullopt after reporting why not.
        std::function<std::optional<std::string>(const std::string& sl_path, base::Diag&,
                                                 const Cancelled&)>
            compile;
        // A hash of everything that decides the bytes of that object.
        std::function<std::optional<std::string>(const std::string& sl_path, base::Diag&,
                                                 const Cancelled&)>
            cache_key;
        // What it takes to have these values as constants; nullopt: it cannot be done. May be
        // empty.
        std::function<std::optional<SpecialShader>(const sl_object&,
                                                   std::span<const BoundValue> constants)>
            specialise;
        // What it takes to have the shader as checked code (sl_services.def, not_a_number). May be
        // empty.
        std::function<std::optional<SpecialShader>(const sl_object&)> checked;
    };
    using Path = std::span<const std::string>;

    ShaderLibrary(Config config, StringTable& strings, base::Diag& diag);
    ~ShaderLibrary();

    // By the name of a shader call: path components bypass the search, a suffix .sl .slo .slc .slx
    // is stripped; `path` is looked through between path_first and search_path. nullptr after one
    // message when missing, broken, of another ABI, or of another type than wanted.
    const ShaderObject* find(std::string_view name, sl_shader_type wanted, base::SourcePos pos,
                             Path path = {});

    // The same for a shader of any type.
    const ShaderObject* find_any(std::string_view name, base::SourcePos pos, Path path = {});

    // This shader will be asked for: it is looked for now and loaded or compiled in the background.
    // What there is to say about it is said when it is asked for, so the order of messages is the
    // order of find(), whatever is finished first. Messages give the first place that named it.
    void prefetch(std::string_view name, base::SourcePos pos, Path path = {});

    // The object of a special shader, if it has been loaded or lies in the cache; else nullptr.
    const ShaderObject* find_special(const SpecialShader& special);
    // Compiles it now, on this thread. nullptr without a message if that fails or is cancelled: the
    // general shader does the same.
    const ShaderObject* make_special(const SpecialShader& special, const Cancelled& cancelled);

    // Ends compilations nobody waits for and removes what they left. Nothing is found afterwards.
    void stop();

    // Loads one object file; nullptr and a message on failure. Checks the fingerprint before
    // anything else.
    const ShaderObject* load(const std::string& slo_path, base::SourcePos pos);

    // An object linked into the program (the built-in default surface; tests): checked like a
    // loaded one, never closed; find() gives it for its name. object must outlive the library.
    const ShaderObject* adopt(const sl_object& object);

    StringTable& strings() { return strings_; }
    [[nodiscard]] const Config& config() const;

    [[nodiscard]] LibraryStats stats() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
    StringTable& strings_;
};

// A value the caller binds to a parameter; converted and checked against the declaration.
struct BoundValue {
    std::string name;
    sl_type type = SL_TYPE_float;
    int array_length = 0;
    std::vector<float> floats; // already in current space for point, vector, normal, matrix
    std::vector<std::string> strings;
    base::SourcePos pos;
};

// A shader with its parameters: immutable after creation, shared by all threads.
class ShaderInstance {
public:
    // Mismatched or unknown values are reported once and left out (ri.md 16.8). services/engine
    // evaluate defaults such as `point "shader" (0,0,0)`; engine must know this instance's spaces.
    ShaderInstance(const ShaderObject& object, std::span<const BoundValue> values,
                   const sl_services& services, void* engine, StringTable& strings,
                   base::Diag& diag);
    // The same parameters for an object made from that of `general`: their blocks must be alike.
    ShaderInstance(const ShaderObject& special, const ShaderInstance& general)
        : object_(special), params_(general.params_), bound_(general.bound_) {}

    [[nodiscard]] const ShaderObject& shader() const { return object_; }
    [[nodiscard]] const sl_object& object() const { return object_.object(); }
    // The finished parameter block: uniform values in place; varying parameters point to nothing
    // and have their uniform value in the staging slot (offset + 16). Batches copy it.
    [[nodiscard]] std::span<const std::byte> params() const;
    // Uniform value of a parameter (message passing, __category, ...): floats or an sl_string.
    [[nodiscard]] const float* uniform_floats(int param) const;
    [[nodiscard]] sl_string uniform_string(int param) const { return *uniform_strings(param); }
    [[nodiscard]] const sl_string* uniform_strings(int param) const; // all elements of an array

private:
    [[nodiscard]] std::byte* value_slot(const sl_param& param);
    [[nodiscard]] const std::byte* value_slot(const sl_param& param) const;
    bool bind(const BoundValue& value, StringTable& strings, base::Diag& diag);

    const ShaderObject& object_;
    std::vector<std::byte> params_;
    std::vector<std::uint8_t> bound_;
};

// Parameters have the same names, types and places, and packets the same length: instances of one
// can stand for those of the other.
[[nodiscard]] bool have_same_block(const ShaderObject& a, const ShaderObject& b);

// "float[3]", "color" ...: how messages and slctell name a type.
[[nodiscard]] std::string type_text(int type, int array_length);
[[nodiscard]] int components_of(int type);

} // namespace rt
