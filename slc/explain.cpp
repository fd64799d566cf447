// SPDX-License-Identifier: Apache-2.0
// In: an optimised program. Out: text in sections, each line "  name  what": variables the shader
// needs and why, uniform and varying names, area operators with their slices, where evaluation at
// the auxiliary points ends, and where the shader may have to wait for the engine. Slices are those
// pass_area works with; operations are statements without bodies.
#include "slc/explain.h"

#include "slc/aux_analysis.h"
#include "slc/ir_util.h"
#include "slc/liveness.h"
#include "slc/passes.h"
#include "slc/suspension.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <set>

namespace slc {

namespace {

constexpr std::size_t line_width = 100;

// Words, broken into lines.
std::string wrapped(const std::string& head, const std::vector<std::string>& words) {
    std::string out = head;
    std::size_t column = head.size();
    for (const std::string& w : words) {
        if (column + 1 + w.size() > line_width) {
            out += "\n" + std::string(head.size(), ' ');
            column = head.size();
        }
        out += " " + w;
        column += w.size() + 1;
    }
    return out + "\n";
}

std::string padded(std::string text, std::size_t width) {
    text.resize(std::max(width, text.size()), ' ');
    return text;
}

bool is_operation(const Stmt& s) {
    return s.bodies.empty() && s.op != Op::Break && s.op != Op::Continue && s.op != Op::Leave;
}

template <class F> void for_each_statement(const Block& b, F use) {
    for (const Stmt& s : b) {
        use(s);
        for (const Block& inner : s.bodies) {
            for_each_statement(inner, use);
        }
    }
}

class Explanation {
public:
    Explanation(const Program& program, const CompileOptions& options)
        : program_(program), resolved_(program), results_(aux_results(program)),
          coarse_(program, nullptr, results_), aux_(program, results_, coarse_),
          slice_(program, &aux_, results_) {
        resolve_area_operators(resolved_, options);
        facts_ = analyse(resolved_);
    }
    std::string text();

private:
    void needed();
    void names();
    void operators();
    void operator_slice(const Stmt& s);
    void evaluation_end();
    void suspensions();
    [[nodiscard]] static std::string user_name(const BuiltinRow& row);
    [[nodiscard]] std::string saved_text(const Suspensions& waits, const Stmt& call) const;
    void line(const std::string& text) { out_ += text + "\n"; }
    [[nodiscard]] std::string place(Loc loc) const;
    [[nodiscard]] std::string lines_of(const Liveness& slice) const;
    [[nodiscard]] static std::string ranges(const std::set<std::uint32_t>& lines);
    [[nodiscard]] std::vector<std::string> inputs_of(const Liveness& slice) const;
    [[nodiscard]] std::size_t operations(const Liveness* slice) const;

    const Program& program_;
    Program resolved_;
    std::uint64_t results_;
    Liveness coarse_;
    AuxAnalysis aux_;
    Liveness slice_;
    Facts facts_;
    std::string out_;
};

std::string Explanation::place(Loc loc) const {
    const std::string file =
        loc.file < program_.files.size() ? program_.files[loc.file] : std::string("?");
    return file + ":" + std::to_string(loc.line) + ":" + std::to_string(loc.col);
}

std::vector<std::string> names_in(std::uint64_t mask) {
    std::vector<std::string> names;
    for (int i = 0; i < SL_VAR_COUNT; ++i) {
        if ((mask >> i & 1) != 0) {
            names.emplace_back(variable_rows()[static_cast<std::size_t>(i)].name);
        }
    }
    return names;
}

void Explanation::needed() {
    line("needed variables");
    std::vector<std::string> explained;
    for (const std::string& reason : facts_.reasons) { // "P: read at ..."
        const std::size_t colon = reason.find(':');
        explained.push_back(reason.substr(0, colon));
        line("  " + padded(explained.back(), 8) + reason.substr(colon + 2));
    }
    for (const std::string& name : names_in(facts_.needed)) {
        if (std::find(explained.begin(), explained.end(), name) == explained.end()) {
            line("  " + padded(name, 8) + "kept where the shader does not set it");
        }
    }
    if (facts_.needed == 0) {
        line("  none");
    }
    std::vector<std::string> differences = names_in(facts_.needed_aux);
    for (std::size_t i = 0; i < facts_.aux_params.size(); ++i) {
        if (facts_.aux_params[i]) {
            const auto id = static_cast<std::size_t>(program_.params[i].var);
            differences.push_back(program_.vars[id].name);
        }
    }
    if (!differences.empty()) {
        out_ += wrapped("at auxiliary points ", differences);
    }
    if (facts_.written_aux != 0) {
        out_ += wrapped("handed on from there", names_in(facts_.written_aux));
    }
}

void Explanation::names() {
    std::vector<std::string> uniform, varying;
    for (const Var& v : program_.vars) {
        if (v.kind == VarKind::Param || v.kind == VarKind::Local) {
            (v.detail == Detail::Uniform ? uniform : varying).push_back(v.name);
        }
    }
    out_ += wrapped("uniform names       ", uniform);
    out_ += wrapped("varying names       ", varying);
}

// 3, 7-9, 12
std::string Explanation::ranges(const std::set<std::uint32_t>& lines) {
    std::string text;
    for (auto it = lines.begin(); it != lines.end();) {
        const std::uint32_t first = *it;
        std::uint32_t last = first;
        while (++it != lines.end() && *it == last + 1) {
            last = *it;
        }
        text += (text.empty() ? "" : ", ") + std::to_string(first) +
                (last > first ? "-" + std::to_string(last) : std::string());
    }
    return text;
}

std::string Explanation::lines_of(const Liveness& slice) const {
    std::map<std::uint32_t, std::set<std::uint32_t>> lines; // by file
    for_each_statement(program_.body, [&](const Stmt& s) {
        if (slice.matters(s)) {
            lines[s.loc.file].insert(s.loc.line);
        }
    });
    std::string text;
    for (const auto& [file, of_file] : lines) {
        const std::string name = file < program_.files.size() ? program_.files[file] : "?";
        text += (text.empty() ? "" : "; ") + (lines.size() > 1 ? name + " " : std::string()) +
                ranges(of_file);
    }
    return text;
}

// Predefined variables and parameters at the start of the slice that differ between the points.
std::vector<std::string> Explanation::inputs_of(const Liveness& slice) const {
    std::vector<std::string> names;
    for (int i = 0; i < SL_VAR_COUNT; ++i) {
        if (slice.at_entry().contains(slice.at_entry().global_slot(i)) &&
            axes_of_global(program_.shader_type, i) != NoAxis) {
            names.emplace_back(variable_rows()[static_cast<std::size_t>(i)].name);
        }
    }
    for (const Param& p : program_.params) {
        if (aux_.differs(p.var) != NoAxis &&
            slice.at_entry().contains(slice.at_entry().slot(program_, p.var))) {
            names.push_back(program_.vars[static_cast<std::size_t>(p.var)].name);
        }
    }
    return names;
}

std::size_t Explanation::operations(const Liveness* slice) const {
    std::size_t n = 0;
    for_each_statement(program_.body, [&](const Stmt& s) {
        n += is_operation(s) && (slice == nullptr || slice->matters(s)) ? 1 : 0;
    });
    return n;
}

void Explanation::operator_slice(const Stmt& s) {
    const Liveness slice(program_, &aux_, 0, &s);
    const BuiltinRow& row = builtin_of(s);
    const unsigned axes = axes_of_operator(row.name);
    std::string along = axes == AxisU ? "along u" : axes == AxisV ? "along v" : "along u and v";
    const std::size_t num = operations(&slice) - 1; // without the operator
    line("  " + padded(std::string(row.name) + "()", 19) + place(s.loc) + ", " + along);
    std::string inputs;
    for (const std::string& name : inputs_of(slice)) {
        inputs += " " + name;
    }
    if (inputs.empty()) {
        line(std::string(21, ' ') + "its argument is the same at all points");
        return;
    }
    line(std::string(21, ' ') + "from" + inputs + "; slice: " + std::to_string(num) +
         (num == 1 ? " operation" : " operations") + ", lines " + lines_of(slice));
}

void Explanation::operators() {
    line("area operators");
    const auto found = area_operators(program_.body);
    for (const Stmt* s : found) {
        operator_slice(*s);
    }
    if (found.empty()) {
        line("  none");
    }
    evaluation_end();
}

void Explanation::evaluation_end() {
    const auto found = area_operators(program_.body);
    if (results_ != 0) {
        line("auxiliary evaluation goes on to the end: the surface gets the displaced differences");
    } else if (!found.empty()) {
        line("auxiliary evaluation ends after " + place(found.back()->loc));
    } else {
        line("no auxiliary evaluation");
        return;
    }
    const std::size_t all = operations(nullptr), sliced = operations(&slice_);
    char share[64];
    std::snprintf(share, sizeof share, "slices: %zu of %zu operations (%.0f %%)", sliced, all,
                  100.0 * static_cast<double>(sliced) /
                      static_cast<double>(std::max<std::size_t>(all, 1)));
    std::size_t after = 0;
    for_each_statement(resolved_.body, [&](const Stmt& s) { after += is_operation(s) ? 1 : 0; });
    line(std::string(share) + "; with differences the shader has " + std::to_string(after));
}

// What a call was in the source: `trace` for `trace_d`.
std::string Explanation::user_name(const BuiltinRow& row) {
    std::string name(row.name);
    const bool has_differences = row.has(PropHidden) && name.ends_with("_d");
    return has_differences ? name.substr(0, name.size() - 2) : name;
}

// What outlives a point where the packet is suspended, in bytes of 8 lanes.
std::string Explanation::saved_text(const Suspensions& waits, const Stmt& call) const {
    constexpr int lanes = 8;
    if (waits.state(call) == 0) {
        return "";
    }
    const SuspensionPoint& point = waits.points()[static_cast<std::size_t>(waits.state(call)) - 1];
    std::size_t bytes = 0;
    std::string names;
    for (const VarId v : point.saved) {
        const Var& saved = resolved_.vars[static_cast<std::size_t>(v)];
        bytes += saved_bytes(saved, lanes);
        names += " " + saved.name;
    }
    return ", waits; saves " + std::to_string(bytes) + " bytes" + (names.empty() ? "" : ":") +
           names;
}

// Where a shader asks the engine for rays and maps, and where it waits for the answer.
void Explanation::suspensions() {
    line("suspension points");
    std::set<std::string> seen; // a map may be looked up at each of the three points
    const Suspensions waits(resolved_);
    for_each_statement(resolved_.body, [&](const Stmt& s) {
        if (s.op == Op::Call && (builtin_of(s).properties & (PropTraces | PropTextures)) != 0) {
            const bool traces = builtin_of(s).has(PropTraces);
            std::string text("  " + padded(user_name(builtin_of(s)) + "()", 19) + place(s.loc) +
                             (traces ? ", rays" : ", maps") + saved_text(waits, s));
            if (seen.insert(text).second) {
                line(text);
            }
        }
    });
    if (seen.empty()) {
        line("  none");
    }
}

std::string Explanation::text() {
    line(std::string(shader_type_name(program_.shader_type)) + " " + program_.name);
    needed();
    names();
    operators();
    suspensions();
    const std::string facts = facts_text(resolved_, facts_);
    const std::size_t at = facts.find("\nfacts:");
    out_ += facts.substr(at + 1, facts.find('\n', at + 1) - at);
    return std::move(out_);
}

} // namespace

std::string explain_text(const Program& program, const CompileOptions& options) {
    return Explanation(program, options).text();
}

} // namespace slc
