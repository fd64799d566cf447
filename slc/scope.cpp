// SPDX-License-Identifier: Apache-2.0
#include "slc/scope.h"

#include "slc/builtins.h"

#include <iterator>

namespace slc {

using ast::Symbol;
using ast::SymbolKind;

Scopes::Scopes(ast::File& file) {
    const auto rows = variable_rows();
    for (std::size_t i = 0; i < rows.size(); ++i) {
        Symbol& symbol = file.symbols.emplace_back();
        symbol.name = rows[i].name;
        symbol.kind = SymbolKind::Global;
        symbol.type = rows[i].type;
        symbol.detail = rows[i].detail;
        symbol.global = static_cast<int>(i);
        globals_.emplace(symbol.name, &symbol);
    }
    Symbol& pi = file.symbols.emplace_back();
    pi.name = "PI";
    pi.kind = SymbolKind::Pi;
    pi.detail = Detail::Uniform;
    globals_.emplace(pi.name, &pi);
    push(false);
}

void Scopes::push(bool is_function) {
    levels_.emplace_back();
    levels_.back().is_function = is_function;
}

Scopes::Found Scopes::find(std::string_view name) const {
    bool beyond = false;
    for (auto level = levels_.rbegin(); level != levels_.rend(); ++level) {
        const auto it = level->variables.find(name);
        if (it != level->variables.end()) {
            return {it->second, beyond};
        }
        beyond = beyond || level->is_function;
    }
    const auto it = globals_.find(name);
    if (it == globals_.end()) {
        return {};
    }
    return {it->second, beyond && it->second->kind != SymbolKind::Pi};
}

Symbol* Scopes::find_outer(std::string_view name) const {
    std::size_t outer = levels_.size() - 1;
    for (std::size_t i = levels_.size(); i-- > 0;) {
        if (levels_[i].is_function) {
            outer = i;
            break;
        }
    }
    for (std::size_t i = outer; i-- > 0;) {
        const auto it = levels_[i].variables.find(name);
        if (it != levels_[i].variables.end()) {
            return it->second;
        }
    }
    const auto it = globals_.find(name);
    return it == globals_.end() ? nullptr : it->second;
}

Scopes::Inner Scopes::leave_for_file() {
    Inner inner(std::make_move_iterator(levels_.begin() + 1),
                std::make_move_iterator(levels_.end()));
    levels_.resize(1);
    return inner;
}

void Scopes::come_back(Inner inner) {
    levels_.insert(levels_.end(), std::make_move_iterator(inner.begin()),
                   std::make_move_iterator(inner.end()));
}

bool Scopes::declare(std::string_view name, Symbol* symbol) {
    return levels_.back().variables.emplace(name, symbol).second;
}

std::vector<ast::Function*> Scopes::find_functions(std::string_view name) const {
    std::vector<ast::Function*> found;
    for (auto level = levels_.rbegin(); level != levels_.rend(); ++level) {
        for (auto f = level->functions.rbegin(); f != level->functions.rend(); ++f) {
            if ((*f)->name == name) {
                found.push_back(*f);
            }
        }
    }
    return found;
}

std::vector<std::string_view> Scopes::variable_names() const {
    std::vector<std::string_view> names;
    for (const Level& level : levels_) {
        for (const auto& [name, symbol] : level.variables) {
            names.push_back(name);
        }
    }
    for (const auto& [name, symbol] : globals_) {
        names.push_back(name);
    }
    return names;
}

std::vector<std::string_view> Scopes::function_names() const {
    std::vector<std::string_view> names;
    for (const Level& level : levels_) {
        for (const ast::Function* f : level.functions) {
            names.push_back(f->name);
        }
    }
    for (const BuiltinRow& row : builtin_rows()) {
        if (!row.has(PropHidden)) {
            names.push_back(row.name);
        }
    }
    return names;
}

} // namespace slc
