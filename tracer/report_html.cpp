// SPDX-License-Identifier: Apache-2.0
// The page of --report: one HTML file that needs nothing else. In: the record of a run. Out: the
// text of the page. Holds: every name and message is escaped; a content security policy lets no
// script run but the page's own, by its hash.
#include "runtime/base/sha256.h"
#include "tracer/html_text.h"
#include "tracer/report_style.h"
#include "tracer/run_record.h"
#include "tracer/version.h"

#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <cstdio>

namespace trace {

namespace {

// --- numbers for people

std::string fixed(double value, int digits) {
    char text[48];
    std::snprintf(text, sizeof text, "%.*f", digits, value);
    return text;
}

// Three significant digits with the letter of the magnitude: 1.23 M.
std::string short_number(double value, bool is_count = true) {
    constexpr const char* letters[] = {"", " k", " M", " G", " T"};
    std::size_t i = 0;
    for (; value >= 999.5 && i + 1 < std::size(letters); ++i) {
        value /= 1000;
    }
    const int digits = i == 0 && is_count ? 0 : value < 9.995 ? 2 : value < 99.95 ? 1 : 0;
    return fixed(value, digits) + letters[i];
}

std::string count_text(std::uint64_t n) {
    return short_number(static_cast<double>(n));
}

std::string seconds_text(double seconds) {
    return seconds < 0.9995 ? short_number(1000 * seconds, false) + " ms"
                            : short_number(seconds, false) + " s";
}

std::string bytes_text(std::uint64_t bytes) {
    return short_number(static_cast<double>(bytes)) + (bytes < 1000 ? " B" : "B");
}

std::string percent(double share) {
    return fixed(100 * share, 1) + " %";
}

// A row's text where a heading or a unit says the beginning already.
std::string_view without(std::string_view text, std::string_view beginning) {
    return text.starts_with(beginning) ? text.substr(beginning.size()) : text;
}

// --- pieces of a page

class Page {
public:
    Page& raw(std::string_view html) {
        out_ += html;
        return *this;
    }
    Page& text(std::string_view any) { return raw(escaped(any)); }
    Page& cell(std::string_view any, const char* kind = "") {
        raw("<td");
        if (*kind != '\0') {
            raw(" class=\"").raw(kind).raw("\"");
        }
        return raw(">").text(any).raw("</td>");
    }
    // A number that sorts by its value.
    Page& number(double value, std::string_view shown) {
        return raw("<td class=\"n\" data-v=\"")
            .raw(fixed(value, 9))
            .raw("\">")
            .text(shown)
            .raw("</td>");
    }
    Page& bar(double share, std::string_view kind = "") {
        const double width = 100 * std::clamp(std::isfinite(share) ? share : 0, 0.0, 1.0);
        return raw("<svg viewBox=\"0 0 100 10\" preserveAspectRatio=\"none\" role=\"img\" "
                   "aria-label=\"")
            .raw(percent(width / 100))
            .raw("\"><rect class=\"track\" width=\"100\" height=\"10\"/><rect class=\"bar ")
            .raw(kind)
            .raw("\" width=\"")
            .raw(fixed(width, 2))
            .raw("\" height=\"10\"/></svg>");
    }
    Page& tile(std::string_view value, std::string_view label) {
        return raw("<div class=\"tile\"><b>")
            .text(value)
            .raw("</b><span>")
            .text(label)
            .raw("</span></div>\n");
    }
    Page& open_card(std::string_view title, std::string_view kind = "") {
        return raw("<section class=\"card ").raw(kind).raw("\"><h3>").text(title).raw("</h3>\n");
    }
    Page& close_card() { return raw("</section>\n"); }
    Page& heading(std::string_view title, bool is_number, bool sorts) {
        raw(is_number ? "<th scope=\"col\" class=\"n\">" : "<th scope=\"col\">");
        return sorts ? raw("<button type=\"button\">").text(title).raw("</button></th>")
                     : text(title).raw("</th>");
    }
    std::string take() { return std::move(out_); }

private:
    std::string out_;
};

// --- what a frame and the whole run show alike

constexpr const char* bar_kinds[] = {"e", "d", "c", "a", "b"};

void times_card(Page& page, const Stats& stats) {
    page.open_card("Time").raw("<table><tbody>\n");
    const double total = stats.total_seconds();
    for (std::size_t i = 0; i < stats.seconds.values.size(); ++i) {
        const double seconds = stats.seconds.values[i];
        page.raw("<tr>").cell(rows_of(Phase{})[i].text).raw("<td>");
        page.bar(total > 0 ? seconds / total : 0, bar_kinds[i % std::size(bar_kinds)]).raw("</td>");
        page.cell(seconds_text(seconds), "n").raw("</tr>\n");
    }
    double work = 0;
    for (const double seconds : stats.parts.values) {
        work += seconds;
    }
    page.raw("</tbody></table>\n<h3>Parts, summed over threads</h3><table><tbody>\n");
    for (std::size_t i = 0; i < stats.parts.values.size(); ++i) {
        const double seconds = stats.parts.values[i];
        page.raw("<tr>").cell(without(rows_of(Part{})[i].text, "threads: ")).raw("<td>");
        page.bar(work > 0 ? seconds / work : 0, bar_kinds[i % std::size(bar_kinds)]).raw("</td>");
        page.cell(seconds_text(seconds), "n").raw("</tr>\n");
    }
    page.raw("</tbody></table>\n").close_card();
}

void counts_card(Page& page, const Stats& stats) {
    page.open_card("Rays and samples").raw("<table><thead><tr>");
    page.heading("", false, false).heading("count", true, false).heading("per second", true, false);
    page.raw("</tr></thead><tbody>\n");
    for (std::size_t i = 0; i < stats.counters.values.size(); ++i) {
        const RowText& row = rows_of(Counter{})[i];
        const std::uint64_t n = stats.counters.values[i];
        page.raw("<tr>").cell(row.text).cell(count_text(n), "n");
        page.cell(row.has_rate && n > 0 ? short_number(stats.rate(static_cast<Counter>(i))) : "",
                  "n");
        page.raw("</tr>\n");
    }
    page.raw("</tbody></table>\n").close_card();
}

void amounts_card(Page& page, const Stats& stats) {
    page.open_card("Scene and memory").raw("<table><tbody>\n");
    const double peak = static_cast<double>(stats.amounts[Amount::peak_bytes]);
    for (std::size_t i = 0; i < stats.amounts.values.size(); ++i) {
        const RowText& row = rows_of(Amount{})[i];
        const std::uint64_t value = stats.amounts.values[i];
        const bool is_bytes = row.id.ends_with("_bytes");
        page.raw("<tr>").cell(without(row.text, "bytes ")).raw("<td>");
        if (is_bytes && peak > 0) {
            page.bar(static_cast<double>(value) / peak, "d");
        }
        page.raw("</td>").cell(is_bytes ? bytes_text(value) : count_text(value), "n");
        page.raw("</tr>\n");
    }
    page.raw("</tbody></table>\n").close_card();
}

void lanes_card(Page& page, const Stats& stats) {
    const double live = stats.mean_live_lanes();
    page.open_card("Lane use").raw("<p>");
    page.text(fixed(live, 2) + " of " + std::to_string(SL_LANES_MAX) +
              " lanes held a point on average (surfaces and volumes)");
    page.raw("</p>").bar(live / static_cast<double>(SL_LANES_MAX), "c").close_card();
}

void shader_row(Page& page, const Stats& stats, const ShaderStats& s) {
    page.raw("<tr>").cell(s.shader.name, "name").cell(shader_type_name(s.shader.type));
    for (const ShaderCount column : {ShaderCount::instances, ShaderCount::points,
                                     ShaderCount::batches, ShaderCount::packets}) {
        page.number(static_cast<double>(s.value[column]), count_text(s.value[column]));
    }
    const double share = stats.share(s);
    page.number(s.mean_live_lanes(), fixed(s.mean_live_lanes(), 2));
    page.number(s.seconds, seconds_text(s.seconds)).number(share, percent(share));
    page.raw("<td>").bar(share, "a").raw("</td></tr>\n");
}

void shaders_card(Page& page, const Stats& stats) {
    if (stats.shaders.empty()) {
        return;
    }
    page.open_card("Shaders", "wide").raw("<table class=\"sortable\"><thead><tr>");
    page.heading("shader", false, true).heading("type", false, true);
    for (const char* title :
         {"sets", "points", "batches", "packets", "lanes of 8", "time", "share"}) {
        page.heading(title, true, true);
    }
    page.raw("<th></th></tr></thead><tbody>\n");
    std::vector<const ShaderStats*> order;
    for (const ShaderStats& s : stats.shaders) {
        order.push_back(&s);
    }
    std::stable_sort(order.begin(), order.end(), [](const ShaderStats* a, const ShaderStats* b) {
        return a->seconds > b->seconds;
    });
    for (const ShaderStats* s : order) {
        shader_row(page, stats, *s);
    }
    page.raw("</tbody></table>\n<p class=\"soft\">Time of all threads. Lights run inside the "
             "surfaces that ask for them: their time is part of the surface's.</p>\n");
    page.close_card();
}

void stats_cards(Page& page, const Stats& stats) {
    shaders_card(page, stats);
    page.raw("<div class=\"grid\">\n");
    counts_card(page, stats);
    page.raw("<div>");
    amounts_card(page, stats);
    page.raw("<div style=\"height:12px\"></div>");
    lanes_card(page, stats);
    page.raw("</div>");
    page.raw("</div>\n");
}

// --- frames

std::string pair_text(const int* values) {
    return std::to_string(values[0]) + " × " + std::to_string(values[1]);
}

std::string list_text(const float* values, std::size_t n) {
    std::string text;
    for (std::size_t i = 0; i < n; ++i) {
        char number[32];
        std::snprintf(number, sizeof number, "%g", static_cast<double>(values[i]));
        text += (i == 0 ? "" : " ") + std::string(number);
    }
    return text;
}

void options_card(Page& page, const FrameRecord& frame) {
    const FrameOptions& o = frame.options;
    page.open_card("Options").raw("<table class=\"options\"><tbody>\n");
    const auto row = [&](const char* name, const std::string& value) {
        page.raw("<tr>").cell(name).cell(value, "name").raw("</tr>\n");
    };
    row("resolution", pair_text(o.resolution));
    row("samples per pixel", pair_text(o.samples));
    row("filter", o.filter + " " + list_text(o.filter_width, 2));
    row("crop window", list_text(o.crop, 4));
    row("exposure: gain, gamma", list_text(&o.gain, 1) + ", " + list_text(&o.gamma, 1));
    row("shutter", list_text(o.shutter, 2));
    row("projection", o.projection);
    row("hider", o.hider);
    for (const FrameOptions::Display& d : o.displays) {
        row("display", d.name + " (" + d.type + ", " + d.mode + ")");
    }
    page.raw("</tbody></table>\n").close_card();
}

void frame_section(Page& page, const FrameRecord& frame, std::size_t index) {
    page.raw("<h2 id=\"frame").raw(std::to_string(index)).raw("\">").text(frame.title());
    if (frame.result != "done") {
        page.raw(" <span class=\"warning\">").text(frame.result).raw("</span>");
    }
    page.raw("</h2>\n<div class=\"grid\">\n");
    if (frame.preview.png.empty()) {
        options_card(page, frame);
        times_card(page, frame.stats);
    } else {
        page.open_card("Picture").raw("<img alt=\"the rendered picture\" width=\"");
        page.raw(std::to_string(frame.preview.width)).raw("\" height=\"");
        page.raw(std::to_string(frame.preview.height)).raw("\" src=\"data:image/png;base64,");
        page.raw(base64(frame.preview.png)).raw("\">").close_card();
        times_card(page, frame.stats);
    }
    page.raw("</div>\n");
    stats_cards(page, frame.stats);
    if (!frame.preview.png.empty()) {
        options_card(page, frame);
    }
}

void frame_list(Page& page, const RunRecord& run) {
    page.open_card("Frames", "wide").raw("<table class=\"sortable\"><thead><tr>");
    page.heading("frame", false, true).heading("result", false, true);
    for (const char* title : {"time", "samples", "hits", "warnings", "errors"}) {
        page.heading(title, true, true);
    }
    page.raw("</tr></thead><tbody>\n");
    for (std::size_t i = 0; i < run.frames.size(); ++i) {
        const FrameRecord& f = run.frames[i];
        const auto count = [&](std::uint64_t n) {
            page.number(static_cast<double>(n), count_text(n));
        };
        page.raw("<tr><td class=\"name\"><a href=\"#frame").raw(std::to_string(i)).raw("\">");
        page.text(f.title()).raw("</a></td>").cell(f.result);
        page.number(f.stats.total_seconds(), seconds_text(f.stats.total_seconds()));
        count(f.stats.counters[Counter::samples]);
        count(f.stats.counters[Counter::hits]);
        count(f.num_messages[static_cast<std::size_t>(base::Severity::Warning)]);
        count(f.num_messages[static_cast<std::size_t>(base::Severity::Error)] +
              f.num_messages[static_cast<std::size_t>(base::Severity::Severe)]);
        page.raw("</tr>\n");
    }
    page.raw("</tbody></table>\n").close_card();
}

// --- the run

void messages_card(Page& page, const RunRecord& run) {
    page.raw("<h2>Messages</h2>\n");
    if (run.messages.empty()) {
        page.raw("<p class=\"soft\">None.</p>\n");
        return;
    }
    page.open_card("By text", "wide").raw("<table class=\"sortable\"><thead><tr>");
    page.heading("severity", false, true).heading("code", false, true).heading("text", false, true);
    page.heading("times", true, true).heading("places", false, true);
    page.raw("</tr></thead><tbody>\n");
    for (const base::MessageRecord& m : run.messages) {
        const std::string severity(base::severity_name(m.severity));
        page.raw("<tr>").cell(severity, severity.c_str()).cell(base::code_name(m.code));
        page.cell(m.text, "text").number(static_cast<double>(m.count), count_text(m.count));
        page.raw("<td class=\"name\">");
        for (const std::string& place : m.places) {
            page.raw("<code>").text(place).raw("</code><br>");
        }
        page.text(m.count > m.places.size() && !m.places.empty() ? "…" : "").raw("</td></tr>\n");
    }
    page.raw("</tbody></table>\n").close_card();
}

void run_card(Page& page, const RunRecord& run) {
    page.raw("<h2>Run</h2>\n").open_card("Machine and command line", "wide");
    page.raw("<table class=\"options\"><tbody>\n");
    const auto row = [&](const char* name, const std::string& value) {
        page.raw("<tr>")
            .cell(name)
            .raw("<td class=\"name\"><code>")
            .text(value)
            .raw("</code></td></tr>\n");
    };
    std::string arguments;
    for (const std::string& argument : run.arguments) {
        arguments += (arguments.empty() ? "" : " ") + argument;
    }
    row("arguments", arguments);
    for (const std::string& file : run.files) {
        row("file", file);
    }
    row("processor",
        run.machine.processor + ", " + std::to_string(run.machine.num_threads) + " threads");
    row("memory", bytes_text(run.machine.memory_bytes));
    row("system", run.machine.system);
    page.raw("</tbody></table>\n").close_card();
}

void head(Page& page, const std::string& title) {
    base::Sha256 hash;
    const base::Sha256::Digest digest = hash.add(report_script).digest();
    const std::string_view bytes(reinterpret_cast<const char*>(digest.data()), digest.size());
    page.raw("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n");
    page.raw("<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src "
             "data:; style-src 'unsafe-inline'; script-src 'sha256-");
    page.raw(base64(bytes)).raw("'\">\n<meta name=\"viewport\" content=\"width=device-width\">\n");
    page.raw("<title>").text(title).raw("</title>\n<style>").raw(report_css);
    page.raw("</style>\n</head>\n<body>\n<main>\n");
}

void summary_tiles(Page& page, const RunRecord& run) {
    const Stats& total = run.total;
    std::uint64_t severities[4] = {};
    for (const base::MessageRecord& m : run.messages) {
        severities[static_cast<std::size_t>(m.severity)] += m.count;
    }
    const std::uint64_t rays = total.counters[Counter::rays_camera] +
                               total.counters[Counter::rays_behind] +
                               total.counters[Counter::rays_shadow];
    page.raw("<div class=\"tiles\">\n");
    page.tile(seconds_text(run.seconds), "start to finish");
    page.tile(count_text(run.frames.size()), run.frames.size() == 1 ? "frame" : "frames");
    page.tile(count_text(total.counters[Counter::samples]), "samples");
    page.tile(count_text(rays), "rays");
    page.tile(bytes_text(total.amounts[Amount::peak_bytes]), "memory at most");
    page.tile(fixed(total.mean_live_lanes(), 2), "live lanes of 8");
    page.tile(count_text(severities[1]), "warnings");
    page.tile(count_text(severities[2] + severities[3]), "errors");
    page.raw("</div>\n");
}

} // namespace

std::string run_html(const RunRecord& run) {
    std::string files;
    for (const std::string& file : run.files) {
        files += (files.empty() ? "" : ", ") + file;
    }
    Page page;
    head(page, "Render report: " + files);
    page.raw("<h1>").text(files.empty() ? "Render report" : files).raw("</h1>\n");
    page.raw("<p class=\"soft\">Render report, ").text(renderer_name).raw(" ");
    page.text(renderer_version_text).raw("</p>\n");
    summary_tiles(page, run);
    if (run.frames.size() > 1) {
        frame_list(page, run);
        page.raw("<div class=\"grid\">\n");
        times_card(page, run.total);
        lanes_card(page, run.total);
        page.raw("</div>\n");
        shaders_card(page, run.total);
    }
    for (std::size_t i = 0; i < run.frames.size(); ++i) {
        frame_section(page, run.frames[i], i);
    }
    messages_card(page, run);
    run_card(page, run);
    page.raw("<footer>Counts and times are explained in docs/statistics.md.</footer>\n</main>\n");
    page.raw("<script>").raw(report_script).raw("</script>\n</body>\n</html>\n");
    return page.take();
}

} // namespace trace
