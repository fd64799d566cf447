// SPDX-License-Identifier: Apache-2.0
// The request table and lookups in it.
#include "ribtools/request.h"

#include "ribtools/spelling.h"

#include <algorithm>
#include <unordered_map>

namespace rib {

namespace {

constexpr RequestRow table[] = {
#define RI_REQUEST(name, c_entry, args, arg_names, params, kind, scope_set, effect, block, motion, \
                   note)                                                                           \
    {#name,                                                                                        \
     #c_entry,                                                                                     \
     args,                                                                                         \
     arg_names,                                                                                    \
     ParamUse::params,                                                                             \
     RequestKind::kind,                                                                            \
     scopes::scope_set,                                                                            \
     BlockEffect::effect,                                                                          \
     BlockKind::block,                                                                             \
     MotionAbility::motion,                                                                        \
     note},
#define RI_SKIPPED(name, note)                                                                     \
    {#name,                                                                                        \
     "RiNone",                                                                                     \
     "",                                                                                           \
     "",                                                                                           \
     ParamUse::None,                                                                               \
     RequestKind::Skipped,                                                                         \
     scopes::Anywhere,                                                                             \
     BlockEffect::None,                                                                            \
     BlockKind::None,                                                                              \
     MotionAbility::Still,                                                                         \
     note},
#include "ribtools/ri_requests.def"
};

constexpr std::size_t num_letters(std::string_view args) {
    return static_cast<std::size_t>(std::count_if(
        args.begin(), args.end(), [](char c) { return c != '?' && c != '(' && c != ')'; }));
}

constexpr std::size_t num_words(std::string_view names) {
    return names.empty()
               ? 0
               : 1 + static_cast<std::size_t>(std::count(names.begin(), names.end(), ' '));
}

// Every argument has a name, and Request has room for all.
static_assert(std::all_of(std::begin(table), std::end(table), [](const RequestRow& r) {
    return num_letters(r.args) == num_words(r.arg_names) &&
           num_letters(r.args) <= Request::max_args;
}));

using NameMap = std::unordered_map<std::string_view, RequestId>;

NameMap make_names() {
    NameMap names;
    for (std::size_t i = 0; i < std::size(table); ++i) {
        names.emplace(table[i].name, static_cast<RequestId>(i));
    }
    names.emplace("Cropwindow", RequestId::CropWindow); // as the specification prints it
    return names;
}

} // namespace

std::span<const RequestRow> request_table() {
    return table;
}

const RequestRow& row(RequestId id) {
    return table[static_cast<std::size_t>(id)];
}

const RequestId* find_request(std::string_view name) {
    static const NameMap names = make_names();
    const auto it = names.find(name);
    return it == names.end() ? nullptr : &it->second;
}

std::string_view similar_request(std::string_view name) {
    Nearest nearest(name);
    for (const RequestRow& r : table) {
        nearest.offer(r.name);
    }
    return nearest.best();
}

std::string_view block_name(BlockKind kind) {
    switch (kind) {
    case BlockKind::None:
        return "outermost level";
    case BlockKind::Frame:
        return "Frame";
    case BlockKind::World:
        return "World";
    case BlockKind::Attribute:
        return "Attribute";
    case BlockKind::Transform:
        return "Transform";
    case BlockKind::Solid:
        return "Solid";
    case BlockKind::Object:
        return "Object";
    case BlockKind::Motion:
        return "Motion";
    case BlockKind::Resource:
        return "Resource";
    }
    return "";
}

void Arg::clear() {
    given = false;
    numbers.clear();
    ints.clear();
    floats.clear();
    strings.clear();
}

void Request::clear() {
    for (Arg& arg : args) {
        arg.clear();
    }
    params.params.clear();
    name.clear();
    values.clear();
}

const std::string& Request::string(int i) const {
    static const std::string empty;
    const auto& strings = args[static_cast<std::size_t>(i)].strings;
    return strings.empty() ? empty : strings.front();
}

} // namespace rib
