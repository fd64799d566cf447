// SPDX-License-Identifier: Apache-2.0
// Strings that vary, where a built-in function takes one text for all points (spaces, maps,
// patterns, formats): it is called once for each combination of texts among the lanes, under the
// mask of the lanes that have it.
#include "slc/builtins.h"
#include "slc/emit_call.h"

#include <algorithm>

namespace slc {

// Gives the varying texts names; arguments are built with those.
void Emitter::name_texts(Call& c) {
    for (std::size_t i = 0; c.lanes && i < c.num_args; ++i) {
        const VarId v = c.s.args[i];
        const bool is_fixed = i < c.row.args.size() || c.row.repeats_last;
        const bool is_output = i < c.row.args.size() && c.row.args[i].is_output;
        const bool is_known = std::any_of(c.texts.begin(), c.texts.end(),
                                          [v](const CallText& text) { return text.var == v; });
        if (!is_fixed || is_output || is_known || var(v).type != Type::String || !varying(v) ||
            var(v).array_length > 0) {
            continue;
        }
        CallText text{v, fresh("texts"), fresh("text")};
        out_.line("const " + std::string(type_word(Form::String, true)) + " " + text.lanes + " = " +
                  use(v).text + ";");
        c.texts.push_back(std::move(text));
    }
    c.mask = c.texts.empty() ? mask(c.b) : fresh("same");
}

std::string Emitter::text_argument(Call& c, VarId v) {
    for (const CallText& text : c.texts) {
        if (text.var == v) {
            return text.one;
        }
    }
    return as_uniform(use(v), c.b).text;
}

// The call, `value`, in a loop over the combinations; what it gives all lanes together.
Expr Emitter::for_each_text(Call& c, const Expr& value) {
    const std::string rest = fresh("rest"), lane = fresh("lane");
    const std::string truth(dialect_.varying_truth);
    Expr result = value;
    if (c.s.dst != no_var) {
        result.text = fresh("result");
        out_.line(std::string(type_word(value.form, true)) + " " + result.text + " = " +
                  zero_of(value.form, true) + ";");
    }
    out_.line(truth + " " + rest + " = " + mask(c.b) + ";");
    out_.open("while (sl_any(" + rest + ")) {");
    out_.line("const int " + lane + " = sl_first_lane(" + rest + ");");
    std::string same = rest;
    for (const CallText& text : c.texts) {
        out_.line("const " + std::string(type_word(Form::String, false)) + " " + text.one +
                  " = slv_lane_s(" + text.lanes + ", " + lane + ");");
        same += " & slv_eq_s(" + text.lanes + ", slv_spread_s(" + text.one + "))";
    }
    out_.line("const " + truth + " " + c.mask + " = " + same + ";");
    if (c.s.dst == no_var) {
        out_.line(value.text + ";");
    } else {
        out_.line(result.text + " = slv_select_" + std::string(form_suffix(value.form)) + "(" +
                  c.mask + ", " + value.text + ", " + result.text + ");");
    }
    out_.line(rest + " &= ~" + c.mask + ";");
    out_.close();
    return result;
}

} // namespace slc
