// SPDX-License-Identifier: Apache-2.0
// Parameter types and access to parameter lists.
#include "ribtools/param.h"

namespace rib {

int components(ParamType type) {
    switch (type) {
    case ParamType::Float:
    case ParamType::Integer:
    case ParamType::String:
    case ParamType::Pointer:
        return 1;
    case ParamType::Color:
    case ParamType::Point:
    case ParamType::Vector:
    case ParamType::Normal:
        return 3;
    case ParamType::HPoint:
        return 4;
    case ParamType::Matrix:
    case ParamType::MPoint:
        return 16;
    }
    return 1;
}

std::size_t Param::num_items() const {
    const auto per_item = static_cast<std::size_t>(decl.array_length);
    if (decl.type == ParamType::String) {
        return strings.size() / per_item;
    }
    if (decl.type == ParamType::Integer) {
        return ints.size() / per_item;
    }
    return floats.size() / (per_item * static_cast<std::size_t>(components(decl.type)));
}

const Param* ParamList::find(std::string_view name) const {
    for (const Param& p : params) {
        if (p.name == name) {
            return &p;
        }
    }
    return nullptr;
}

float ParamList::get_float(std::string_view name, float fallback) const {
    const Param* p = find(name);
    if (!p) {
        return fallback;
    }
    return !p->floats.empty() ? p->floats.front()
           : !p->ints.empty() ? static_cast<float>(p->ints.front())
                              : fallback;
}

int ParamList::get_int(std::string_view name, int fallback) const {
    const Param* p = find(name);
    if (!p) {
        return fallback;
    }
    if (!p->ints.empty()) {
        return p->ints.front();
    }
    // Guessed or declared as float; beyond int the value means nothing here.
    const bool fits = !p->floats.empty() && p->floats.front() > -2e9f && p->floats.front() < 2e9f;
    return fits ? static_cast<int>(p->floats.front()) : fallback;
}

std::vector<float> ParamList::get_numbers(std::string_view name) const {
    const Param* p = find(name);
    if (!p) {
        return {};
    }
    return p->floats.empty() ? std::vector<float>(p->ints.begin(), p->ints.end()) : p->floats;
}

std::string ParamList::get_string(std::string_view name, std::string_view fallback) const {
    const Param* p = find(name);
    return p && !p->strings.empty() ? p->strings.front() : std::string(fallback);
}

} // namespace rib
