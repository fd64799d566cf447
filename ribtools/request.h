// SPDX-License-Identifier: Apache-2.0
// One request as read: its row of ri_requests.def, its positional arguments, its parameter list,
// its place. Made by the parser (or later the C binding), consumed by the graphics state.
#pragma once

#include "ribtools/param.h"
#include "runtime/base/diag.h"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace rib {

enum class RequestId : std::uint8_t {
#define RI_REQUEST(name, ...) name,
#define RI_SKIPPED(name, ...) name,
#include "ribtools/ri_requests.def"
    Unknown // outside the table; only where requests are kept as they are written
};

enum class BlockKind : std::uint8_t {
    None, // outside every block
    Frame,
    World,
    Attribute,
    Transform,
    Solid,
    Object,
    Motion,
    Resource,
};
enum class BlockEffect : std::uint8_t { None, Open, Close };
enum class RequestKind : std::uint8_t {
    Option,
    Attribute,
    Transform,
    Primitive,
    Block,
    Texture,
    Other,
    Skipped
};
enum class ParamUse : std::uint8_t { None, Primvars, Shader, Option, Attribute, Free };
enum class MotionAbility : std::uint8_t { Still, Moves };

// Sets of block kinds (bit = BlockKind). Attribute, Transform, Solid and Resource blocks keep the
// legality of what encloses them: see Blocks::is_legal.
namespace scopes {
constexpr unsigned bit(BlockKind kind) {
    return 1u << static_cast<unsigned>(kind);
}
constexpr unsigned Outermost = bit(BlockKind::None);
constexpr unsigned BeforeWorld = Outermost | bit(BlockKind::Frame);
constexpr unsigned Nested = bit(BlockKind::Attribute) | bit(BlockKind::Transform) |
                            bit(BlockKind::Solid) | bit(BlockKind::Resource);
constexpr unsigned Lights = BeforeWorld | bit(BlockKind::World) | Nested;
constexpr unsigned Archives = Lights;
constexpr unsigned Everywhere = Lights | bit(BlockKind::Object);
constexpr unsigned Anywhere = Everywhere | bit(BlockKind::Motion);
constexpr unsigned Surfaces = bit(BlockKind::World) | bit(BlockKind::Object) | Nested;
constexpr unsigned Definition = Lights & ~bit(BlockKind::Solid);
constexpr unsigned PlaneScope = Definition;
} // namespace scopes

struct RequestRow {
    std::string_view name;
    std::string_view c_entry;
    std::string_view args;
    std::string_view arg_names;
    ParamUse params;
    RequestKind kind;
    unsigned scopes;
    BlockEffect effect;
    BlockKind block;
    MotionAbility motion;
    std::string_view note;
};

[[nodiscard]] std::span<const RequestRow> request_table();
[[nodiscard]] const RequestRow& row(RequestId id);
// nullptr for an unknown name. "Cropwindow" is CropWindow.
[[nodiscard]] const RequestId* find_request(std::string_view name);
// The known name nearest to a misspelt one, or "".
[[nodiscard]] std::string_view similar_request(std::string_view name);

[[nodiscard]] std::string_view block_name(BlockKind kind);

// One positional argument. Which vector is used follows from its code in the row.
struct Arg {
    bool given = false;
    std::vector<double> numbers;      // f v: 1; c: 3 (RGB); b: 6; m: 16; B given as a matrix: 16
    std::vector<std::int32_t> ints;   // i: 1; I
    std::vector<float> floats;        // F
    std::vector<std::string> strings; // s h B: 1; S. Integer handles are their decimal text

    void clear();
};

// One value of a request whose arguments nobody knows: a number, a string, or an array of either.
struct LooseValue {
    bool is_array = false;
    std::vector<double> numbers;
    std::vector<std::string> strings;
};

struct Request {
    static constexpr int max_args = 11;

    RequestId id{};
    base::SourcePos pos;
    std::array<Arg, max_args> args; // as many as the row has; the rest is not given
    ParamList params;
    // Of requests outside RI 3.2, where they are kept: name and values as they stand.
    std::string name;
    std::vector<LooseValue> values;

    void clear();
    [[nodiscard]] double number(int i) const { return args[i].numbers.front(); }
    [[nodiscard]] float real(int i) const { return static_cast<float>(number(i)); }
    [[nodiscard]] std::int32_t integer(int i) const { return args[i].ints.front(); }
    // "" when not given.
    [[nodiscard]] const std::string& string(int i) const;
};

} // namespace rib
