// SPDX-License-Identifier: Apache-2.0
// Compiled shaders as the engine uses them: found on a search path, loaded once, instanced with bound parameters.
//
// ShaderLibrary owns objects for a whole run and is safe from any thread; objects stay loaded until it goes. Where
// only `name.sl` is found it is compiled into the content-addressed user cache through the compile function it
// was given (the runtime does not know slc).
#pragma once

#include "runtime/abi/sl_abi.h"
#include "runtime/base/diag.h"

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

// Strings of a run: equal texts share one pointer (sl_string).
class StringTable {
public:
    sl_string intern(std::string_view text);

private:
    std::mutex mutex_;
    std::unordered_set<std::string> texts_; // node-based: addresses stay
};

// One loaded .slo.
class ShaderObject {
public:
    ~ShaderObject();
    [[nodiscard]] const sl_object& object() const { return *object_; }
    // The best variant this processor can run.
    [[nodiscard]] const sl_variant& variant() const { return *variant_; }
    [[nodiscard]] const std::vector<sl_string>& strings() const { return strings_; }
    // Index of a parameter, or -1.
    [[nodiscard]] int find_param(std::string_view name) const;

private:
    friend class ShaderLibrary;
    ShaderObject() = default;
    void* handle_ = nullptr;
    const sl_object* object_ = nullptr;
    const sl_variant* variant_ = nullptr;
    std::vector<sl_string> strings_;
};

class ShaderLibrary {
public:
    struct Config {
        std::vector<std::string> search_path;   // directories (or library files), in order
        std::string cache_dir;                  // "" = no cache, compile to a temporary file
        // Compiles an .sl file into an .slo at the given path; false after reporting why not.
        std::function<bool(const std::string& sl_path, const std::string& slo_path, base::Diag&)> compile;
        // Identifies compiler, flags and tables for the cache key (preprocessed text is added to it).
        std::function<std::optional<std::string>(const std::string& sl_path, base::Diag&)> cache_key;
    };

    ShaderLibrary(Config config, StringTable& strings, base::Diag& diag);
    ~ShaderLibrary();

    // By the name of a shader call: path components bypass the search, a suffix .sl .slo .slc .slx is stripped.
    // nullptr after one message when missing, broken, of another ABI, or of another type than wanted.
    const ShaderObject* find(std::string_view name, sl_shader_type wanted, base::SourcePos pos);

    // Loads one object file; nullptr and a message on failure. Checks the fingerprint before anything else.
    const ShaderObject* load(const std::string& slo_path, base::SourcePos pos);

    // An object linked into the program (the built-in default surface; tests): checked like a loaded one, never
    // closed. object must outlive the library.
    const ShaderObject* adopt(const sl_object& object);

    StringTable& strings() { return strings_; }

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
    // Mismatched or unknown values are reported once and left out (ri.md 16.8). services/engine evaluate
    // defaults such as `point "shader" (0,0,0)`; engine must know this instance's spaces.
    ShaderInstance(const ShaderObject& object, std::span<const BoundValue> values,
                   const sl_services& services, void* engine, StringTable& strings, base::Diag& diag);

    [[nodiscard]] const ShaderObject& shader() const { return object_; }
    [[nodiscard]] const sl_object& object() const { return object_.object(); }
    // The finished parameter block: uniform values in place; varying parameters point to nothing and have their
    // uniform value in the staging slot (offset + 16). Batches copy it.
    [[nodiscard]] std::span<const std::byte> params() const;
    // Uniform value of a parameter (message passing, __category, ...): floats or an sl_string.
    [[nodiscard]] const float* uniform_floats(int param) const;
    [[nodiscard]] sl_string uniform_string(int param) const;

private:
    const ShaderObject& object_;
    std::vector<std::byte> params_;
};

} // namespace rt
