// SPDX-License-Identifier: Apache-2.0
// Checking of definitions and declarations: scopes, extern, function signatures.
#include "slc/check.h"

#include <algorithm>
#include <utility>

namespace slc {

using ast::Function;
using ast::Symbol;
using ast::SymbolKind;
using ast::Variable;

void check(ast::File& file, Externals& externals, Messages& messages) {
    Checker(file, externals, messages).run();
}

void Checker::run() {
    for (const ast::Definition& d : file_.definitions) {
        if (messages_.too_many()) {
            return;
        }
        if (d.function != nullptr) {
            if (!d.function->checked) {
                check_function(*d.function);
            }
        } else {
            check_shader(*d.shader);
        }
    }
}

void Checker::check_shader(ast::Shader& shader) {
    scopes_.push(false);
    std::erase_if(shader.params, [&](const Variable& param) {
        const bool again = !declared_params_.insert(param.symbol->name).second;
        if (again) {
            messages_.warning(param.symbol->loc, "parameter " + quoted(param.symbol->name) +
                                                     " is declared again; the first stands");
        }
        return again;
    });
    declared_params_.clear();
    for (Variable& param : shader.params) {
        check_initialiser(param); // a default may use earlier parameters
        if (param.symbol->array_length == ast::unsized_array) {
            messages_.error(param.symbol->loc, "array parameter " + quoted(param.symbol->name) +
                                                   " needs a length or a list of values");
            param.symbol->array_length = 1;
        }
        declare(*param.symbol);
    }
    scopes_.push(false);
    loop_depth_ = 0;
    statements(shader.body);
    scopes_.pop();
    scopes_.pop();
}

void Checker::check_function(Function& function) {
    Function* const outer = function_;
    const int outer_loops = loop_depth_;
    function_ = &function;
    loop_depth_ = 0;
    open_functions_.push_back(&function);
    scopes_.push(true);
    for (Symbol* formal : function.formals) {
        declare(*formal);
    }
    scopes_.push(false);
    statements(function.body);
    scopes_.pop();
    scopes_.pop();
    open_functions_.pop_back();
    if (!function.result) {
        function.result = Type::Void; // note 8: no return with a value was seen
    }
    function.checked = true;
    function_ = outer;
    loop_depth_ = outer_loops;
    declare_function(function); // visible from here on, so a function cannot call itself
}

namespace {

bool same_signature(const Function& a, const Function& b) {
    if (a.formals.size() != b.formals.size()) {
        return false;
    }
    for (std::size_t i = 0; i < a.formals.size(); ++i) {
        if (a.formals[i]->type != b.formals[i]->type ||
            (a.formals[i]->array_length != 0) != (b.formals[i]->array_length != 0)) {
            return false;
        }
    }
    return a.result == b.result;
}

} // namespace

void Checker::declare_function(Function& function) {
    for (const Function* other : scopes_.find_functions(function.name)) {
        if (same_signature(*other, function)) {
            messages_.warning(function.loc, "function " + quoted(function.name) +
                                                " is defined again; this one is used from here on");
            break;
        }
    }
    scopes_.declare_function(&function);
}

// Macros declare what the shader has declared; from the second declaration on it is another
// variable.
void Checker::declare(Symbol& symbol) {
    if (!scopes_.declare(symbol.name, &symbol)) {
        messages_.warning(symbol.loc, quoted(symbol.name) +
                                          " is declared again in this scope; this one is used from "
                                          "here on");
        scopes_.replace(symbol.name, &symbol);
    }
}

// A function of the file that is called before its definition, in the scope of the file.
void Checker::check_later_function(std::string_view name) {
    for (const ast::Definition& d : file_.definitions) {
        const bool is_open =
            d.function != nullptr && std::find(open_functions_.begin(), open_functions_.end(),
                                               d.function) != open_functions_.end();
        if (d.function == nullptr || d.function->checked || is_open || d.function->name != name) {
            continue;
        }
        Function* const outer = std::exchange(function_, nullptr);
        Scopes::Inner inner = scopes_.leave_for_file();
        check_function(*d.function);
        scopes_.come_back(std::move(inner));
        function_ = outer;
    }
}

void Checker::check_initialiser(Variable& variable) {
    Symbol& symbol = *variable.symbol;
    const std::string what = "the value of " + quoted(symbol.name);
    for (ast::Expr* e : variable.elements) {
        deliver(*e, symbol.type, what);
    }
    if (variable.init == nullptr) {
        return;
    }
    const Symbol* source = symbol.array_length != 0 ? array_of(*variable.init) : nullptr;
    if (source != nullptr) {
        if (source->type != symbol.type || source->array_length != symbol.array_length) {
            messages_.error(variable.init->loc, "array " + quoted(source->name) +
                                                    " does not have the type and length of " +
                                                    quoted(symbol.name));
        }
        return;
    }
    deliver(*variable.init, symbol.type, what);
}

// `extern` names a variable of an enclosing scope (sl.md 1.5). Point, vector and normal may stand
// for each other: shaders of 3.1 declare all three as point.
void Checker::declare_extern(Variable& variable) {
    Symbol& wanted = *variable.symbol;
    Symbol* found = scopes_.find_outer(wanted.name);
    if (found == nullptr) {
        const auto names = scopes_.variable_names();
        messages_.error(wanted.loc, "no variable " + quoted(wanted.name) + " encloses this one" +
                                        spelling_hint(wanted.name, names));
        declare(wanted);
        return;
    }
    const bool interchange = is_pvn(wanted.type) && is_pvn(found->type);
    if (wanted.type != Type::Void && wanted.type != found->type && !interchange) {
        messages_.warning(wanted.loc, quoted(wanted.name) + " is " +
                                          std::string(type_name(found->type)) + ", not " +
                                          std::string(type_name(wanted.type)) +
                                          "; it is used as what it is");
    }
    if (variable.init != nullptr || variable.has_elements) {
        messages_.error(wanted.loc, "an extern variable cannot be given a value here");
    }
    if (!scopes_.declare(found->name, found)) {
        messages_.warning(wanted.loc, quoted(wanted.name) + " is already declared in this scope");
    }
}

} // namespace slc
