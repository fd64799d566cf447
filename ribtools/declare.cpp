// SPDX-License-Identifier: Apache-2.0
#include "ribtools/declare.h"

#include "ribtools/spelling.h"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <map>
#include <utility>

namespace rib {

namespace {

constexpr std::pair<std::string_view, StorageClass> storage_names[] = {
    {"constant", StorageClass::Constant},       {"uniform", StorageClass::Uniform},
    {"varying", StorageClass::Varying},         {"vertex", StorageClass::Vertex},
    {"facevarying", StorageClass::FaceVarying}, {"facevertex", StorageClass::FaceVertex}};

constexpr std::pair<std::string_view, ParamType> type_names[] = {
    {"float", ParamType::Float},   {"integer", ParamType::Integer},
    {"int", ParamType::Integer},   {"string", ParamType::String},
    {"color", ParamType::Color},   {"point", ParamType::Point},
    {"vector", ParamType::Vector}, {"normal", ParamType::Normal},
    {"hpoint", ParamType::HPoint}, {"matrix", ParamType::Matrix},
    {"mpoint", ParamType::MPoint}, {"pointer", ParamType::Pointer}};

// More elements per item than any use has; keeps products of counts small.
constexpr int max_array_length = 1 << 20;

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v';
}

bool same_word(std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
        return (x >= 'A' && x <= 'Z' ? static_cast<char>(x - 'A' + 'a') : x) == y;
    });
}

template <class T, std::size_t N>
const T* lookup(const std::pair<std::string_view, T> (&names)[N], std::string_view word) {
    for (const auto& [name, value] : names) {
        if (same_word(word, name)) {
            return &value;
        }
    }
    return nullptr;
}

// Words, "[", and "]" of a declaration.
class Words {
public:
    explicit Words(std::string_view text) : text_(text) {}

    // "" at the end.
    std::string_view peek() {
        while (!text_.empty() && is_blank(text_.front())) {
            text_.remove_prefix(1);
        }
        std::size_t n = 0;
        while (n < text_.size() && !is_blank(text_[n]) && text_[n] != '[' && text_[n] != ']') {
            ++n;
        }
        return text_.substr(0, n == 0 && !text_.empty() ? 1 : n);
    }
    void skip() { text_.remove_prefix(peek().size()); }

private:
    std::string_view text_;
};

// [ n ], when one stands there. False: malformed.
bool parse_array(Words& words, ParamDecl& decl) {
    if (words.peek() != "[") {
        return true;
    }
    words.skip();
    const std::string_view digits = words.peek();
    int n = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), n);
    if (error != std::errc() || end != digits.data() + digits.size() || n < 1 ||
        n > max_array_length) {
        return false;
    }
    words.skip();
    if (words.peek() != "]") {
        return false;
    }
    words.skip();
    decl.array_length = n;
    decl.is_array = true;
    return true;
}

std::string unknown_type(std::string_view word) {
    if (word.empty()) {
        return "a type is missing";
    }
    Nearest nearest(word);
    for (const auto& entry : type_names) {
        nearest.offer(entry.first);
    }
    std::string text = "'" + printable(word) + "' is not a type";
    return nearest.best().empty() ? text : text + " (" + std::string(nearest.best()) + "?)";
}

Declaration parse_type(Words& words) {
    Declaration d;
    if (same_word(words.peek(), "reference")) {
        d.is_reference = true;
        words.skip();
    }
    if (const StorageClass* storage = lookup(storage_names, words.peek())) {
        d.decl.storage = *storage;
        words.skip();
    }
    const ParamType* type = lookup(type_names, words.peek());
    if (!type) {
        d.error = unknown_type(words.peek());
        return d;
    }
    d.decl.type = *type;
    words.skip();
    if (!parse_array(words, d.decl)) {
        d.error = "malformed array length";
    }
    return d;
}

} // namespace

Declaration parse_declaration(std::string_view text) {
    Words words(text);
    Declaration d = parse_type(words);
    if (d.error.empty() && !words.peek().empty()) {
        d.error = "unexpected '" + printable(words.peek()) + "'";
    }
    return d;
}

Declaration parse_inline_declaration(std::string_view text) {
    Words words(text);
    Declaration d = parse_type(words);
    if (!d.error.empty()) {
        return d;
    }
    d.name = words.peek();
    words.skip();
    if (d.name.empty() || d.name == "[" || d.name == "]") {
        d.error = "the name is missing";
    } else if (!d.decl.is_array && !parse_array(words, d.decl)) {
        d.error = "malformed array length";
    } else if (!words.peek().empty()) {
        d.error = "unexpected '" + printable(words.peek()) + "'";
    }
    return d;
}

bool is_inline_declaration(std::string_view token) {
    return std::any_of(token.begin(), token.end(), is_blank);
}

std::string declaration_text(const ParamDecl& decl) {
    std::string text;
    for (const auto& [name, storage] : storage_names) {
        if (storage == decl.storage) {
            text = name;
        }
    }
    text += ' ';
    const auto* type = std::find_if(std::begin(type_names), std::end(type_names),
                                    [&](const auto& entry) { return entry.second == decl.type; });
    text += decl.type == ParamType::Integer ? "int" : type->first;
    if (decl.is_array) {
        text += "[" + std::to_string(decl.array_length) + "]";
    }
    return text;
}

Dictionary::Dictionary() {
    static constexpr std::pair<std::string_view, std::string_view> predeclared[] = {
#define RI_PARAM(name, declaration, note) {#name, declaration},
#include "ribtools/ri_params.def"
    };
    for (const auto& [name, text] : predeclared) {
        set(name, {parse_declaration(text).decl, true, false});
    }
}

const Dictionary::Entry* Dictionary::find(std::string_view name) const {
    const auto it = entries_.find(name);
    return it == entries_.end() ? nullptr : &it->second;
}

void Dictionary::set(std::string_view name, const Entry& entry) {
    entries_.insert_or_assign(std::string(name), entry);
}

void Dictionary::remove(std::string_view name) {
    const auto it = entries_.find(name);
    if (it != entries_.end()) {
        entries_.erase(it);
    }
}

namespace {

constexpr OptionRow options[] = {
#define RI_OPTION(category, group, name, type, fallback, note)                                     \
    {OptionCategory::category, group, name, type, fallback, note},
#include "ribtools/ri_options.def"
};

} // namespace

const OptionRow* find_option(OptionCategory category, std::string_view group,
                             std::string_view name) {
    for (const OptionRow& r : options) {
        if (r.category == category && (r.group == group || r.group == "*") &&
            (r.name == name || r.name == "*")) {
            return &r;
        }
    }
    return nullptr;
}

std::optional<ParamDecl> option_type(const OptionRow& row) {
    if (row.type == "any") {
        return std::nullopt;
    }
    return parse_declaration(row.type).decl;
}

std::string similar_option(OptionCategory category, std::string_view group, std::string_view name) {
    const std::string wanted = std::string(group) + " " + std::string(name);
    std::string best;
    std::size_t best_distance = std::max<std::size_t>(1, wanted.size() / 4) + 1;
    for (const OptionRow& r : options) {
        const std::string candidate = std::string(r.group) + " " + std::string(r.name);
        const std::size_t distance = edit_distance(wanted, candidate);
        if (r.category == category && r.name != "*" && distance < best_distance) {
            best_distance = distance;
            best = candidate;
        }
    }
    return best;
}

} // namespace rib
