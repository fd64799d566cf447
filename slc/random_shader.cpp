// SPDX-License-Identifier: Apache-2.0
#include "slc/random_shader.h"

#include "slc/builtins.h"

#include <algorithm>
#include <array>
#include <random>
#include <vector>

namespace slc {

namespace {

constexpr int max_expression_depth = 4;
constexpr int max_block_depth = 3;
constexpr int num_functions = 3;
constexpr int num_outputs = 6;
constexpr int array_length = 4;

constexpr std::array<Type, 6> value_types = {Type::Float,  Type::Color,  Type::Point,
                                             Type::Vector, Type::Normal, Type::Matrix};

struct Name {
    std::string text;
    Type type = Type::Float;
    bool is_array = false;
    bool is_writable = false;
    bool is_uniform = false;
};

struct Function {
    std::string name;
    Type result = Type::Float;
    std::vector<Type> args;
    Type output = Type::Float; // of the last argument
};

class Writer {
public:
    Writer(unsigned seed, bool is_uniform) : random_(seed), is_uniform_(is_uniform) {
        for (const BuiltinRow& row : builtin_rows()) {
            if (row.has(PropPure) && is_callable(row)) {
                rows_.push_back(&row);
            }
        }
    }

    RandomShader run() {
        for (int i = 0; i < num_functions; ++i) {
            function(i);
        }
        RandomShader shader;
        const std::string inputs = parameters(shader.num_inputs);
        locals();
        fill(1, false);
        std::string outputs;
        std::string results;
        for (int i = 0; i < num_outputs; ++i) {
            const Type type = value_types[static_cast<std::size_t>(i) % value_types.size()];
            const std::string name = "out" + std::to_string(i);
            outputs += "    output varying " + word(type) + " " + name + " = 0;\n";
            line(name + " = " + expression(type, 1, false) + ";", 1);
        }
        shader.source =
            functions_ + "surface random_shader(\n" + inputs + outputs + ")\n{\n" + body_ + "}\n";
        return shader;
    }

private:
    int pick(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }
    template <class T> const T& one_of(const std::vector<T>& from) {
        return from[static_cast<std::size_t>(pick(static_cast<int>(from.size())))];
    }
    Type any_type() {
        return value_types[static_cast<std::size_t>(pick(static_cast<int>(value_types.size())))];
    }
    static std::string word(Type type) { return std::string(type_name(type)); }
    void line(const std::string& text, int depth) {
        body_ += std::string(static_cast<std::size_t>(depth) * 4, ' ') + text + "\n";
    }

    // Texts have to mean something (splines, colour spaces), outputs need variables.
    static bool is_callable(const BuiltinRow& row) {
        return std::none_of(row.args.begin(), row.args.end(),
                            [&row](const ArgSpec& a) {
                                return a.is_output || a.kind == ArgKind::Anything ||
                                       (a.type == Type::String && row.name != "spline" &&
                                        row.name != "ctransform");
                            }) &&
               row.result.type != Type::String && !row.has(PropChannel) && !row.takes_pairs;
    }

    // --- declarations

    std::string parameters(int& count) {
        std::string text;
        const std::vector<Type> types = {Type::Float, Type::Float,  Type::Float, Type::Color,
                                         Type::Point, Type::Vector, Type::Normal};
        for (const Type type : types) {
            const std::string name = "in" + std::to_string(count++);
            text += std::string("    ") + (is_uniform_ ? "uniform " : "varying ") + word(type) +
                    " " + name + " = 0;\n";
            names_.push_back({name, type, false, false, false}); // the same in both worlds
        }
        return text;
    }

    void locals() {
        for (const Type type : value_types) {
            const std::string name = "x" + word(type);
            line(word(type) + " " + name + " = " + expression(type, 2, false) + ";", 1);
            names_.push_back({name, type, false, true, false});
        }
        line("uniform float u0 = " + expression(Type::Float, 3, true) + ";", 1);
        names_.push_back({"u0", Type::Float, false, false, true});
        for (const Type type : {Type::Float, Type::Color}) {
            const std::string name = "a" + word(type);
            line(word(type) + " " + name + "[" + std::to_string(array_length) + "];", 1);
            for (int i = 0; i < array_length; ++i) {
                line(name + "[" + std::to_string(i) + "] = " + expression(type, 3, false) + ";", 1);
            }
            names_.push_back({name, type, true, true, false});
        }
    }

    // A function sees its arguments only; one in three returns early.
    void function(int number) {
        Function f;
        f.name = "f" + std::to_string(number);
        f.result = any_type();
        std::vector<Name> outer;
        outer.swap(names_);
        std::string head = word(f.result) + " " + f.name + "(";
        const int num_args = 1 + pick(3);
        for (int i = 0; i < num_args; ++i) {
            f.args.push_back(any_type());
            const std::string name = "p" + std::to_string(i);
            head += word(f.args.back()) + " " + name + "; ";
            names_.push_back({name, f.args.back(), false, false, false});
        }
        f.output = any_type();
        head += "output " + word(f.output) + " q)\n{\n";
        names_.push_back({"q", f.output, false, true, false});
        std::string saved;
        saved.swap(body_);
        if (pick(3) == 0) {
            line("if (" + condition(2, false) + ") {", 1);
            line("q = " + bounded(f.output, 2) + ";", 2);
            line("return " + expression(f.result, 2, false) + ";", 2);
            line("}", 1);
        }
        line("q = " + bounded(f.output, 1) + ";", 1);
        line("return " + expression(f.result, 1, false) + ";", 1);
        functions_ += head + body_ + "}\n\n";
        body_ = saved;
        names_.swap(outer);
        user_functions_.push_back(f);
    }

    // --- statements

    void fill(int depth, bool in_loop) {
        const int n = 2 + pick(4);
        for (int i = 0; i < n; ++i) {
            statement(depth, in_loop);
        }
    }

    void statement(int depth, bool in_loop) {
        const int kind = depth > max_block_depth ? pick(6) : pick(12);
        if (kind <= 3) {
            assignment(depth);
        } else if (kind == 4) {
            const Name array = *variable(true);
            line(array.text + "[" + index(depth) + "] = " + bounded(array.type, 1) + ";", depth);
        } else if (kind == 5) {
            call(depth);
        } else if (kind <= 8) {
            branch(depth, in_loop);
        } else {
            loop(depth);
        }
    }

    // Values stay of moderate size however often the statement runs.
    void assignment(int depth) {
        const Name to = *variable(false);
        static constexpr const char* operators[] = {" = ", " += ", " -= "};
        const bool may_add = to.type != Type::Matrix && pick(3) == 0;
        line(to.text + operators[may_add ? 1 + pick(2) : 0] + bounded(to.type, 1) + ";", depth);
    }

    void call(int depth) {
        const Function& f = one_of(user_functions_);
        const Name* output = nullptr;
        for (const Name& n : names_) {
            output = n.is_writable && !n.is_array && n.type == f.output ? &n : output;
        }
        if (output == nullptr) {
            return assignment(depth);
        }
        const std::string place = output->text;
        std::string text = f.name + "(";
        for (const Type type : f.args) {
            text += expression(type, 2, false) + ", ";
        }
        line("x" + word(f.result) + " = " + clamped(f.result, text + place + ")") + ";", depth);
    }

    void branch(int depth, bool in_loop) {
        line("if (" + condition(1, pick(3) == 0) + ") {", depth);
        fill(depth + 1, in_loop);
        if (in_loop && pick(3) == 0) {
            line(pick(2) == 0 ? "break;" : "continue;", depth + 1);
        }
        line("}", depth);
        if (pick(2) == 0) {
            line("else {", depth);
            fill(depth + 1, in_loop);
            line("}", depth);
        }
    }

    // Rounds are few: constants, or what an input makes of them.
    void loop(int depth) {
        const std::string i = "i" + std::to_string(num_loops_++);
        line((pick(2) == 0 ? "uniform float " : "float ") + i + ";", depth);
        const bool is_free = pick(2) == 0;
        const std::string bound =
            is_free ? "1 + mod(floor(2 * " + expression(Type::Float, 3, false) + "), 3)"
                    : std::to_string(2 + pick(3));
        const std::string limit = "n" + i;
        line("float " + limit + " = " + bound + ";", depth);
        if (pick(3) == 0) {
            line(i + " = 0;", depth);
            line("while (" + i + " < " + limit + ") {", depth);
            line(i + " += 1;", depth + 1);
        } else {
            line("for (" + i + " = 0; " + i + " < " + limit + "; " + i + " += 1) {", depth);
        }
        fill(depth + 1, true);
        line("}", depth);
    }

    // --- expressions

    const Name* variable(bool is_array) {
        std::vector<const Name*> found;
        for (const Name& n : names_) {
            if (n.is_writable && n.is_array == is_array) {
                found.push_back(&n);
            }
        }
        return one_of(found);
    }

    std::string index(int depth) {
        return pick(2) == 0 ? std::to_string(pick(array_length))
                            : "mod(floor(" + expression(Type::Float, depth + 1, false) + "), " +
                                  std::to_string(array_length) + ")";
    }

    // Not a flat place everywhere: limits are far from where values usually are.
    std::string bounded(Type type, int depth) {
        return clamped(type, expression(type, depth, false));
    }
    static std::string clamped(Type type, const std::string& text) {
        if (type == Type::Matrix) {
            return text;
        }
        const std::string kind = type == Type::Float ? "" : word(type) + " ";
        return "clamp(" + text + ", " + kind + "(-9), " + kind + "(9))";
    }

    std::string number() {
        static constexpr const char* numbers[] = {"0",   "1",    "2",   "0.5", "0.25",
                                                  "1.5", "-0.5", "0.1", "3",   "0.7"};
        return numbers[pick(std::size(numbers))];
    }

    std::string condition(int depth, bool uniform) {
        static constexpr const char* relations[] = {" < ", " <= ", " > ", " >= ", " == ", " != "};
        const Type type = pick(4) == 0 ? Type::Vector : Type::Float;
        std::string text = expression(type, depth + 2, uniform) + relations[pick(6)] +
                           expression(type, depth + 2, uniform);
        if (pick(4) == 0) {
            text = "(" + text + ")" + (pick(2) == 0 ? " && " : " || ") + "(" +
                   expression(Type::Float, depth + 2, uniform) + " > 0.5)";
        }
        return pick(6) == 0 ? "!(" + text + ")" : text;
    }

    std::string expression(Type type, int depth, bool uniform) {
        if (depth >= max_expression_depth) {
            return leaf(type, uniform);
        }
        switch (pick(8)) {
        case 0:
            return leaf(type, uniform);
        case 1:
        case 2:
            return operation(type, depth, uniform);
        case 3:
            return construction(type, depth, uniform);
        case 4:
            return type == Type::Matrix ? leaf(type, uniform)
                                        : "((" + condition(depth, uniform) + ") ? " +
                                              expression(type, depth + 1, uniform) + " : " +
                                              expression(type, depth + 1, uniform) + ")";
        default:
            return builtin(type, depth, uniform);
        }
    }

    std::string leaf(Type type, bool uniform) {
        std::vector<const Name*> found;
        for (const Name& n : names_) {
            if (n.type == type && (!uniform || n.is_uniform)) {
                found.push_back(&n);
            }
        }
        if (!found.empty() && pick(5) != 0) {
            const Name& n = *one_of(found);
            return n.is_array ? n.text + "[" + std::to_string(pick(array_length)) + "]" : n.text;
        }
        if (type == Type::Float) {
            return number();
        }
        return type == Type::Matrix
                   ? "matrix " + number()
                   : word(type) + " (" + number() + ", " + number() + ", " + number() + ")";
    }

    std::string operation(Type type, int depth, bool uniform) {
        const auto inner = [&](Type t) { return expression(t, depth + 1, uniform); };
        if (type == Type::Matrix) {
            return "(" + inner(type) + (pick(3) == 0 ? " / " : " * ") + inner(type) + ")";
        }
        switch (pick(6)) {
        case 0:
            return "(" + inner(type) + " + " + inner(type) + ")";
        case 1:
            return "(" + inner(type) + " - " + inner(type) + ")";
        case 2:
            return "(" + inner(type) + " * " + inner(pick(2) == 0 ? type : Type::Float) + ")";
        case 3:
            return "(" + inner(type) + " / " + inner(Type::Float) + ")";
        case 4:
            return type == Type::Float
                       ? "(" + inner(Type::Vector) + " . " + inner(Type::Normal) + ")"
                   : type == Type::Color ? "(" + inner(type) + " * " + inner(type) + ")"
                                         : word(type) + " (" + inner(Type::Vector) + " ^ " +
                                               inner(Type::Vector) + ")";
        default:
            return "(-" + inner(type) + ")";
        }
    }

    std::string construction(Type type, int depth, bool uniform) {
        const auto part = [&] { return expression(Type::Float, depth + 2, uniform); };
        switch (type) {
        case Type::Float:
            return "comp(" +
                   expression(pick(2) == 0 ? Type::Color : Type::Vector, depth + 1, uniform) +
                   ", " + std::to_string(pick(3)) + ")";
        case Type::Matrix: {
            std::string text = "matrix (";
            for (int i = 0; i < 16; ++i) {
                text += (i == 0 ? "" : ", ") + (i % 5 == 0 ? "2" : pick(3) == 0 ? part() : "0.1");
            }
            return text + ")";
        }
        default:
            return word(type) + " (" + part() + ", " + part() + ", " + part() + ")";
        }
    }

    std::string builtin(Type type, int depth, bool uniform) {
        const bool has_arrays = std::ranges::count_if(names_, &Name::is_array) == 2;
        std::vector<const BuiltinRow*> found;
        for (const BuiltinRow* row : rows_) {
            const bool fits =
                row->result.kind == ArgKind::Exact ? row->result.type == type : is_triple(type);
            const bool has_arguments =
                has_arrays || std::ranges::none_of(row->args, &ArgSpec::is_array);
            if (fits && has_arguments &&
                (row->result.kind != ArgKind::Pvn || type != Type::Color)) {
                found.push_back(row);
            }
        }
        if (found.empty()) {
            return leaf(type, uniform);
        }
        const BuiltinRow& row = *one_of(found);
        std::string text = std::string(row.name) + "(";
        const std::size_t n =
            row.args.size() + (row.repeats_last ? static_cast<std::size_t>(pick(2)) : 0);
        for (std::size_t i = 0; i < n; ++i) {
            text += (i == 0 ? "" : ", ") + argument(row, row.args[std::min(i, row.args.size() - 1)],
                                                    i, type, depth, uniform);
        }
        text += ")";
        // Where the row leaves the kind of triple open, it is said.
        return row.result.kind == ArgKind::Exact ? text : word(type) + " " + text;
    }

    std::string argument(const BuiltinRow& row, const ArgSpec& spec, std::size_t i, Type wanted,
                         int depth, bool uniform) {
        static constexpr const char* bases[] = {"\"bezier\"", "\"catmull-rom\"", "\"linear\""};
        static constexpr const char* spaces[] = {"\"rgb\"", "\"hsv\"", "\"hsl\"", "\"xyz\"",
                                                 "\"yiq\""};
        if (spec.is_array) {
            return "a" + word(spec.type == Type::Color ? Type::Color : Type::Float);
        }
        if (spec.type == Type::String && spec.kind == ArgKind::Exact) {
            return row.name == "spline" ? bases[pick(3)] : spaces[pick(5)];
        }
        // Periods and knots of noise and splines are like any other number.
        static_cast<void>(i);
        const Type type = spec.kind != ArgKind::Pvn                         ? spec.type
                          : wanted == Type::Point || wanted == Type::Normal ? wanted
                                                                            : Type::Vector;
        return expression(type, depth + 1, uniform);
    }

    std::mt19937 random_;
    bool is_uniform_;
    std::vector<const BuiltinRow*> rows_;
    std::vector<Name> names_;
    std::vector<Function> user_functions_;
    std::string functions_;
    std::string body_;
    int num_loops_ = 0;
};

} // namespace

RandomShader random_shader(unsigned seed, bool is_uniform) {
    return Writer(seed, is_uniform).run();
}

} // namespace slc
