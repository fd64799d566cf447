// SPDX-License-Identifier: Apache-2.0
// Statements to IR. `is_tail` says that nothing of the function follows the statement: a return
// there needs no jump.
#include "slc/builtins.h"
#include "slc/lower.h"

namespace slc {

using ast::Expr;
using ast::ExprKind;
using ast::StmtKind;

namespace {

// True if a return in the list is not in tail position.
bool returns_early(const std::vector<ast::Stmt*>& list, bool is_tail);

bool returns_early(const ast::Stmt& s, bool is_tail) {
    switch (s.kind) {
    case StmtKind::Return:
        return !is_tail;
    case StmtKind::Block:
        return returns_early(s.body, is_tail);
    case StmtKind::If:
        for (const ast::Stmt* part : s.body) {
            if (returns_early(*part, is_tail)) {
                return true;
            }
        }
        return false;
    case StmtKind::While:
    case StmtKind::For:
    case StmtKind::Solar:
    case StmtKind::Illuminate:
    case StmtKind::Illuminance:
    case StmtKind::Gather:
        return returns_early(s.body, false);
    default:
        return false;
    }
}

bool returns_early(const std::vector<ast::Stmt*>& list, bool is_tail) {
    for (std::size_t i = 0; i < list.size(); ++i) {
        if (returns_early(*list[i], is_tail && i + 1 == list.size())) {
            return true;
        }
    }
    return false;
}

} // namespace

void Lowering::body(const std::vector<ast::Stmt*>& list) {
    if (!returns_early(list, true)) {
        statements(list, true);
        return;
    }
    Block inner = block([&] { statements(list, true); });
    emit(Op::Scope, no_var, {}, list.front()->loc).bodies.push_back(std::move(inner));
}

void Lowering::statements(const std::vector<ast::Stmt*>& list, bool is_tail) {
    for (std::size_t i = 0; i < list.size(); ++i) {
        statement(*list[i], is_tail && i + 1 == list.size());
    }
}

void Lowering::statement(const ast::Stmt& s, bool is_tail) {
    const Deeper deeper(*this, s.loc);
    switch (s.kind) {
    case StmtKind::Empty:
    case StmtKind::Extern:
    case StmtKind::Function:
        break;
    case StmtKind::Block:
        statements(s.body, is_tail);
        break;
    case StmtKind::Declare:
        declaration(s);
        break;
    case StmtKind::Expression:
        value(*s.exprs[0]);
        break;
    case StmtKind::If:
        if_statement(s, is_tail);
        break;
    case StmtKind::While:
    case StmtKind::For:
        loop(s);
        break;
    case StmtKind::Break:
    case StmtKind::Continue:
        emit(s.kind == StmtKind::Break ? Op::Break : Op::Continue, no_var, {}, s.loc).levels =
            s.levels;
        break;
    case StmtKind::Return:
        return_statement(s, is_tail);
        break;
    case StmtKind::Solar:
    case StmtKind::Illuminate:
        illuminate(s);
        break;
    case StmtKind::Illuminance:
        illuminance(s);
        break;
    case StmtKind::Gather:
        gather(s);
        break;
    }
}

// Locals without a value start at zero each time control reaches them (sl.md 1.5). In `float x = x`
// the right x is an outer one: it has its own symbol.
void Lowering::declaration(const ast::Stmt& s) {
    for (const ast::Variable& v : s.variables) {
        const VarId id = local_for(*v.symbol);
        if (v.init == nullptr && !v.has_elements) {
            emit(Op::Copy, id, {zero(v.symbol->type)}, v.symbol->loc);
        } else {
            initialise(v, id);
        }
    }
}

void Lowering::initialise(const ast::Variable& variable, VarId target) {
    if (variable.init != nullptr) {
        const bool whole_array = variable.init->kind == ExprKind::Name &&
                                 variable.init->symbol != nullptr &&
                                 variable.init->symbol->array_length != 0;
        if (whole_array) {
            emit(Op::Copy, target, {this->variable(*variable.init->symbol, variable.init->loc)},
                 variable.init->loc);
        } else if (variable.symbol->array_length != 0) {
            emit(Op::Copy, target, {value_as(*variable.init, variable.symbol->type)},
                 variable.init->loc);
        } else {
            store_into(*variable.init, target);
        }
        return;
    }
    if (constant_elements(variable, target)) {
        return;
    }
    if (static_cast<int>(variable.elements.size()) < variable.symbol->array_length) {
        emit(Op::Copy, target, {zero(variable.symbol->type)}, variable.symbol->loc);
    }
    for (std::size_t i = 0; i < variable.elements.size(); ++i) {
        const VarId element = value_as(*variable.elements[i], variable.symbol->type);
        emit(Op::Store, target, {constant(static_cast<float>(i)), element},
             variable.elements[i]->loc);
    }
}

namespace {

// A literal number, or its negative.
bool literal(const Expr& e, float& value) {
    if (e.kind == ExprKind::Number) {
        value = static_cast<float>(e.number);
        return true;
    }
    if (e.kind == ExprKind::Unary && e.op == Op::Neg && literal(*e.args[0], value)) {
        value = -value;
        return true;
    }
    return false;
}

// Components of a literal element of the given type.
bool literal_components(const Expr& e, Type type, std::vector<float>& out) {
    float x = 0;
    if (e.kind == ExprKind::Tuple) {
        for (const Expr* part : e.args) {
            if (!literal(*part, x)) {
                return false;
            }
            out.push_back(x);
        }
        return true;
    }
    if (!literal(e, x) || type == Type::Matrix || type == Type::String) {
        return false;
    }
    out.insert(out.end(), static_cast<std::size_t>(num_components(type)), x);
    return true;
}

} // namespace

// An array of literals is one constant instead of one store per element.
bool Lowering::constant_elements(const ast::Variable& variable, VarId target) {
    std::vector<float> values;
    for (const Expr* e : variable.elements) {
        if (!literal_components(*e, variable.symbol->type, values)) {
            return false;
        }
    }
    const int length = variable.symbol->array_length;
    values.resize(static_cast<std::size_t>(length) *
                  static_cast<std::size_t>(num_components(variable.symbol->type)));
    emit(Op::Copy, target, {constant(variable.symbol->type, std::move(values), length)},
         variable.symbol->loc);
    return true;
}

void Lowering::if_statement(const ast::Stmt& s, bool is_tail) {
    const VarId condition = value_as(*s.exprs[0], Type::Float);
    Block then = block([&] { statement(*s.body[0], is_tail); });
    Block otherwise;
    if (s.body.size() > 1) {
        otherwise = block([&] { statement(*s.body[1], is_tail); });
    }
    Stmt& out = emit(Op::If, no_var, {condition}, s.loc);
    out.bodies.push_back(std::move(then));
    out.bodies.push_back(std::move(otherwise));
}

void Lowering::loop(const ast::Stmt& s) {
    if (s.kind == StmtKind::For) {
        statement(*s.body[0], false);
    }
    VarId condition = no_var;
    Block test = block(
        [&] { condition = s.exprs.empty() ? constant(1) : value_as(*s.exprs[0], Type::Float); });
    Block repeated = block([&] { statement(*s.body.back(), false); });
    Block step = block([&] {
        for (const Expr* e : s.steps) {
            value(*e);
        }
    });
    Stmt& out = emit(Op::Loop, no_var, {condition}, s.loc);
    out.bodies.push_back(std::move(test));
    out.bodies.push_back(std::move(repeated));
    out.bodies.push_back(std::move(step));
}

void Lowering::return_statement(const ast::Stmt& s, bool is_tail) {
    if (!s.exprs.empty() && result_ != no_var) {
        store_into(*s.exprs[0], result_);
    }
    if (!is_tail) {
        emit(Op::Leave, no_var, {}, s.loc);
    }
}

// illuminate and solar: light shaders only, one at a time (sl.md 5.4)
void Lowering::illuminate(const ast::Stmt& s) {
    const std::string word = s.kind == StmtKind::Solar ? "'solar'" : "'illuminate'";
    if (shader_.type != SL_SHADER_light) {
        messages_.error_once(s.loc, word + " belongs in light shaders");
    } else if (illuminate_depth_ > 0) {
        messages_.error_once(s.loc, word + " inside another illuminate or solar");
    }
    const std::vector<Type> types = s.kind == StmtKind::Solar
                                        ? std::vector{Type::Vector, Type::Float}
                                        : std::vector{Type::Point, Type::Vector, Type::Float};
    std::vector<VarId> args = operands(s.exprs, types);
    ++illuminate_depth_;
    Block inner = block([&] { statement(*s.body[0], false); });
    --illuminate_depth_;
    Stmt& out = emit(s.kind == StmtKind::Solar ? Op::Solar : Op::Illuminate, no_var,
                     std::move(args), s.loc);
    out.bodies.push_back(std::move(inner));
}

void Lowering::illuminance(const ast::Stmt& s) {
    const bool allowed = shader_.type == SL_SHADER_surface || shader_.type == SL_SHADER_volume ||
                         shader_.type == SL_SHADER_displacement;
    if (!allowed) {
        messages_.error_once(s.loc, "'illuminance' belongs in surface and volume shaders");
    } else if (illuminance_depth_ > 0) {
        messages_.error_once(s.loc, "'illuminance' inside another illuminance");
    }
    std::size_t next = 0;
    const VarId category = s.has_category ? value_as(*s.exprs[next++], Type::String) : no_var;
    std::vector<VarId> args = {value_as(*s.exprs[next++], Type::Point)};
    if (next < s.exprs.size() && s.exprs[next]->type != Type::String) {
        args.push_back(value_as(*s.exprs[next++], Type::Vector));
        args.push_back(value_as(*s.exprs[next++], Type::Float));
    }
    auto pairs = option_values(s, next);
    ++illuminance_depth_;
    Block inner = block([&] { statement(*s.body[0], false); });
    --illuminance_depth_;
    Stmt& out = emit(Op::Illuminance, no_var, std::move(args), s.loc);
    out.category = category;
    out.options = std::move(pairs);
    out.bodies.push_back(std::move(inner));
}

// A loop over single rays (sl.md 4.9):
//   gather(c, P, d, a, n, "surface:Ci", x) hit; else miss;
//   ->  for (i = 0; i < n; i += 1) { if (ray(c, P, d, a, i, n, "surface:Ci", x)) hit; else miss; }
void Lowering::gather(const ast::Stmt& s) {
    const int row = row_of_body("gather_ray");
    std::vector<VarId> args =
        operands({s.exprs.begin(), s.exprs.begin() + 5},
                 {Type::String, Type::Point, Type::Vector, Type::Float, Type::Float});
    const VarId sample = local("sample", Type::Float, 0, s.loc);
    args.insert(args.begin() + 4, sample);
    std::vector<std::pair<std::string, VarId>> outputs;
    for (const auto& [name, id] : option_values(s, 5)) {
        if (builtin_rows()[static_cast<std::size_t>(row)].sets_pair(name)) {
            outputs.emplace_back(name, id);
        } else {
            args.push_back(text(name));
            args.push_back(id);
        }
    }
    for (VarId& id : args) { // the body may change them
        id = id == sample || var(id).array_length != 0 ? id : protect(id, s.loc);
    }
    const VarId count = args[5];
    emit(Op::Copy, sample, {constant(0)}, s.loc);
    const VarId more = temp(Type::Float, s.loc);
    Block test = block([&] { emit(Op::Lt, more, {sample, count}, s.loc); });
    Block round = block([&] {
        const VarId hit = temp(Type::Float, s.loc);
        Stmt& ray = emit(Op::Call, hit, args, s.loc);
        ray.builtin = row;
        ray.options = outputs;
        Block met = block([&] { statement(*s.body[0], false); });
        Block miss;
        if (s.body.size() > 1) {
            miss = block([&] { statement(*s.body[1], false); });
        }
        Stmt& out = emit(Op::If, no_var, {hit}, s.loc);
        out.bodies.push_back(std::move(met));
        out.bodies.push_back(std::move(miss));
    });
    Block step = block([&] { emit(Op::Add, sample, {sample, constant(1)}, s.loc); });
    Stmt& out = emit(Op::Loop, no_var, {more}, s.loc);
    out.bodies.push_back(std::move(test));
    out.bodies.push_back(std::move(round));
    out.bodies.push_back(std::move(step));
}

// Name/value pairs from expression `first` on; values to be set are the variables themselves.
std::vector<std::pair<std::string, VarId>> Lowering::option_values(const ast::Stmt& s,
                                                                   std::size_t first) {
    std::vector<std::pair<std::string, VarId>> pairs;
    for (std::size_t i = first; i + 1 < s.exprs.size(); i += 2) {
        const Expr& e = *s.exprs[i + 1];
        const bool is_variable = e.kind == ExprKind::Name && e.symbol != nullptr;
        pairs.emplace_back(s.exprs[i]->text, is_variable ? variable(*e.symbol, e.loc) : value(e));
    }
    return pairs;
}

} // namespace slc
