// SPDX-License-Identifier: Apache-2.0
// The emitter's core: turns one block of IR (a shader's body, or a parameter's default) into
// statements of a C dialect. In: a program, where its control flow needs masks (emit_flow.h), the
// words of the dialect. Out: lines of text. The core never names a C type or qualifier itself, so
// that another dialect shares all of it.
//
// Masks: `live` are the packet's lanes; every block that some lanes skip has a mask of its own,
// declared before it and narrowed when lanes leave. A variable is declared where its first
// assignment is, whenever all its uses lie in that block; such assignments need no blending,
// because lanes outside the mask have no further use for it.
#pragma once

#include "slc/emit_flow.h"
#include "slc/ir.h"
#include "slc/loop_bounds.h"
#include "slc/suspension.h"

#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace slc {

// How a type is held: the suffix of operations and the row of the dialect's type table.
enum class Form : std::uint8_t { Float, Triple, Matrix, String };

[[nodiscard]] Form form_of(Type type);
[[nodiscard]] std::string_view form_suffix(Form form); // "f" "3" "m" "s"

// The words in which the dialects differ.
struct Dialect {
    std::string_view uniform_types[4]; // by Form
    std::string_view varying_types[4];
    std::string_view uniform_truth; // conditions
    std::string_view varying_truth;
    std::string_view param_pointer; // qualifier of pointers into the parameter block
};

enum class Prec : std::uint8_t { Atom, Unary, Multiply, Add, Compare, BitAnd, And, Or, Choose };

// A piece of text with what must be known to use it.
struct Expr {
    std::string text;
    Form form = Form::Float;
    bool varying = false;
    bool truth = false; // a condition: a mask when varying, an int when uniform
    Prec prec = Prec::Atom;
};

// Literals of an object, in the order of first use.
class StringPool {
public:
    std::size_t add(const std::string& text);
    [[nodiscard]] const std::vector<std::string>& texts() const { return texts_; }

private:
    std::vector<std::string> texts_;
    std::map<std::string, std::size_t> index_;
};

// Indented lines.
class Lines {
public:
    explicit Lines(int depth = 0) : depth_(depth) {}
    void line(std::string_view text);
    void raw(std::string_view text); // no indentation: preprocessor lines, labels
    void open(std::string_view text) {
        line(text);
        ++depth_;
    }
    void close(std::string_view text = "}") {
        --depth_;
        line(text);
    }
    void turn(std::string_view text) { // } else {
        close(text);
        ++depth_;
    }
    void append(const Lines& lines) { text_ += lines.text_; }
    [[nodiscard]] const std::string& text() const { return text_; }

private:
    std::string text_;
    int depth_ = 0;
};

// What a variable is called in emitted text: the SL name wherever C allows it.
[[nodiscard]] std::vector<std::string> c_names(const Program& program);
[[nodiscard]] std::string c_string(std::string_view text); // a C string literal
[[nodiscard]] std::string float_literal(float value);

class Emitter {
public:
    enum class Mode { Shade, Init };

    Emitter(const Program& program, const Block& body, std::uint64_t results, Mode mode,
            const Dialect& dialect, const std::vector<std::string>& names, StringPool& strings,
            Lines& out, std::string label_suffix = "");

    // Declares what is needed, then the statements, then the stores.
    void emit_body();

    // From now on emitted code stamps the places it comes to, by their rows in `places`.
    void stamp_places(std::vector<Loc>& places) { places_ = &places; }
    // From now on emitted code tells where values stop being numbers (emit_check.cpp).
    void check_numbers() { checked_ = true; }
    // The code returns SL_SUSPENDED at these points (emit_suspend.cpp).
    void wait_at(const Suspensions& points);
    // Of the body that has been emitted.
    void declare_frame(Lines& out) const;

private:
    // --- values (emit_expr.cpp)
    [[nodiscard]] const Var& var(VarId v) const {
        return program_.vars[static_cast<std::size_t>(v)];
    }
    [[nodiscard]] bool varying(VarId v) const { return flow_.is_varying(v); }
    [[nodiscard]] Form form(VarId v) const { return form_of(var(v).type); }
    [[nodiscard]] std::string_view type_word(Form form, bool is_varying) const;
    [[nodiscard]] std::string declarator(VarId v, bool constant) const;
    [[nodiscard]] std::string zero(VarId v);
    [[nodiscard]] std::string zero_of(Form form, bool is_varying);
    [[nodiscard]] Expr constant(const Var& v);
    [[nodiscard]] std::string string_literal(const std::string& text);
    Expr use(VarId v); // takes a deferred expression in
    [[nodiscard]] Expr name_of(VarId v) const;
    [[nodiscard]] Expr as_form(Expr e, Form form) const;
    [[nodiscard]] Expr as_varying(Expr e) const;
    [[nodiscard]] Expr as_float(Expr e) const; // from a condition
    [[nodiscard]] Expr as_truth(Expr e) const;
    [[nodiscard]] Expr as_uniform(Expr e, const Block& b) const;
    [[nodiscard]] Expr fit(Expr e, Form form, bool is_varying) const;
    [[nodiscard]] static std::string wrap(const Expr& e, Prec around, bool right = false);
    [[nodiscard]] Expr value_of(const Stmt& s, const Block& b);
    [[nodiscard]] Expr arithmetic(const Stmt& s, bool is_varying);
    [[nodiscard]] Expr triple_arithmetic(const Stmt& s, const Expr& a, const Expr& b,
                                         bool is_varying) const;
    [[nodiscard]] Expr compare(const Stmt& s, bool is_varying);
    [[nodiscard]] Expr logic(const Stmt& s, bool is_varying);
    [[nodiscard]] Expr choose(const Stmt& s, bool is_varying);
    [[nodiscard]] Expr compose(const Stmt& s, bool is_varying);
    [[nodiscard]] Expr component(const Stmt& s, bool is_varying);
    [[nodiscard]] Expr load(const Stmt& s, bool is_varying);
    [[nodiscard]] Expr index_of(VarId v, int length);
    [[nodiscard]] static Expr apply(std::string_view function, Form result, bool is_varying,
                                    std::initializer_list<std::string> arguments);

    // --- calls (emit_call.cpp)
    struct Call;
    void call(const Stmt& s, const Block& b);
    void finish_call(const Call& c, const Expr& value);
    [[nodiscard]] bool runs_on_lanes(const Stmt& s) const;
    void fixed_arguments(Call& c);
    // emit_distinct.cpp
    void name_texts(Call& c);
    [[nodiscard]] std::string text_argument(Call& c, VarId v);
    [[nodiscard]] Expr for_each_text(Call& c, const Expr& value);
    void differences(Call& c);
    void output_argument(Call& c, VarId v);
    void value_arguments(Call& c, std::size_t first);
    void output_pairs(Call& c);
    void spline_arguments(Call& c);
    [[nodiscard]] std::string knot_array(Call& c, std::size_t first);
    [[nodiscard]] Expr chained(Call& c);
    [[nodiscard]] std::string typed_value(VarId v);
    [[nodiscard]] std::string address_of(VarId v);
    void refresh_planes(std::uint64_t reads, const Block& b);
    void store_outputs(const Block& b);

    // --- waiting for rays (emit_suspend.cpp)
    struct Kept { // of the emitted code itself
        std::string name;
        bool is_light_loop; // else a mask
    };
    [[nodiscard]] bool waits(const Stmt& s) const;
    void waiting_call(const Stmt& s, const Block& b);
    void question(Call& c);
    [[nodiscard]] std::vector<Kept> control_state(const Block& b) const;
    void save_and_restore(const SuspensionPoint& point, const Block& b, bool restores);
    void declare_record(const SuspensionPoint& point, const Block& b);
    void send_again(const Block& b);
    void resume_switch();

    // --- checks (emit_check.cpp)
    [[nodiscard]] bool is_checkable(VarId v) const;
    void emit_check(Form form, const std::string& value, const std::string& lanes, const Loc& loc,
                    const std::string& what);
    [[nodiscard]] std::string zero_divisors(const Stmt& s);
    void check_value(VarId v, const Stmt& s, const Block& b, const std::string& zeros = "");
    void check_inputs();

    // --- statements and control (emit_control.cpp)
    void block(const Block& b);
    void statement(const Stmt& s, const Block& b);
    void branch(const Stmt& s, const Block& b);
    void loop(const Stmt& s, const Block& b);
    void uniform_loop(const Stmt& s, const Block& b);
    void masked_loop(const Stmt& s, const Block& b);
    void count_step(const Stmt& s, const Block& b, const std::string& running);
    [[nodiscard]] std::vector<std::string> masks_around(const Block& b,
                                                        const std::string& but) const;
    void scope(const Stmt& s, const Block& b);
    void illuminance(const Stmt& s, const Block& b);
    void light_options(const Stmt& s, const std::string& lights);
    void light_sends(const Stmt& s, const std::string& lights);
    [[nodiscard]] std::string lights_around(const Block& b) const;
    void illuminate(const Stmt& s, const Block& b);
    void leave(const Stmt& s, const Block& b);
    void masked_leave(const Stmt& s, const Block& b);
    void jump(const Stmt& s, const Block& b);
    void place_label(const std::string& label);
    void store_element(const Stmt& s, const Block& b);
    void copy_array(const Stmt& s, const Block& b);
    void note_place(const Loc& loc);
    void stamp(const Loc& loc);
    void forget_place();
    [[nodiscard]] const std::string& mask(const Block& b) const { return masks_.at(&b); }
    [[nodiscard]] std::string fresh(std::string_view stem);

    // --- assignment and deferral (emit_common.cpp)
    void assign(VarId dst, const Expr& value, const Block& b);
    void declare_at_top();
    void load_global(VarId v);
    void load_param(VarId v);
    void load_aux(VarId v);
    void store_aux(VarId v);
    void store_results();
    void store_param(VarId v, const std::string& lanes);
    [[nodiscard]] bool may_defer(const Stmt& s, const Block& b) const;
    void defer(VarId dst, Expr value);
    void settle(VarId v); // writes a deferred value into a variable of its own
    void settle_all();
    void settle_readers(VarId written); // those whose operands are about to change
    [[nodiscard]] bool is_truth(VarId v) const { return truths_.count(v) > 0; }
    void find_truths(const Block& b);

    struct Deferred {
        VarId var;
        Expr value;
        std::vector<VarId> reads;
    };

    const Program& program_;
    const Block& body_;
    std::uint64_t results_;
    Mode mode_;
    const Dialect& dialect_;
    const std::vector<std::string>& names_;
    StringPool& strings_;
    Lines& out_;
    std::string label_suffix_; // keeps the labels of several bodies in one function apart
    Flow flow_;
    CountedLoops counted_;
    bool checked_ = false;
    const Suspensions* waits_ = nullptr;
    bool keeps_counters_ = false;
    Lines records_{2}; // members of the frame
    std::unordered_map<const Block*, std::string> masks_;
    std::unordered_map<const Stmt*, std::string>
        stems_; // "loop_1": names of a construct's masks and labels
    std::unordered_set<std::string> labels_used_;
    std::unordered_set<VarId> declared_;
    std::unordered_set<VarId> truths_;
    std::vector<Deferred> deferred_;
    std::vector<VarId> reading_;        // operands of the expression being built
    std::vector<const Stmt*> jumpable_; // innermost C loop last
    std::map<std::string, int> counters_;
    std::vector<Loc>* places_ = nullptr;   // of a profile
    const Block* stamped_block_ = nullptr; // that holds the statement being written
    std::uint32_t place_line_ = 0;
    std::uint32_t place_file_ = 0;
};

} // namespace slc
