// SPDX-License-Identifier: Apache-2.0
// Statistics for programs: the JSON that docs/statistics.md describes. Keys of counts and times are
// the ids of stats.def. Names from RIB files that are no UTF-8 get replacement characters.
#include "tracer/run_record.h"
#include "tracer/shader_profile.h"
#include "tracer/version.h"

#include <nlohmann/json.hpp>

namespace trace {

namespace {

using Json = nlohmann::ordered_json;

template <class Row, class Value> Json per_row(const PerRow<Row, Value>& values) {
    Json out = Json::object();
    for (std::size_t i = 0; i < values.values.size(); ++i) {
        out[std::string(rows_of(Row{})[i].id)] = values.values[i];
    }
    return out;
}

Json rates(const Stats& stats) {
    Json out = Json::object();
    for (std::size_t i = 0; i < stats.counters.values.size(); ++i) {
        const RowText& row = rows_of(Counter{})[i];
        if (row.has_rate) {
            out[std::string(row.id)] = stats.rate(static_cast<Counter>(i));
        }
    }
    return out;
}

Json shader_list(const Stats& stats) {
    Json out = Json::array();
    for (const ShaderStats& s : stats.shaders) {
        Json row = {{"name", s.shader.name},
                    {"type", shader_type_name(s.shader.type)},
                    {"source", s.shader.source}};
        row.update(per_row(s.value));
        row["mean_live_lanes"] = s.mean_live_lanes();
        row["seconds"] = s.seconds;
        row["share"] = stats.share(s);
        out.push_back(std::move(row));
    }
    return out;
}

void add_stats(Json& to, const Stats& stats) {
    to["seconds"] = per_row(stats.seconds);
    to["parts"] = per_row(stats.parts);
    to["counters"] = per_row(stats.counters);
    to["rates"] = rates(stats);
    to["amounts"] = per_row(stats.amounts);
    to["mean_live_lanes"] = stats.mean_live_lanes();
    to["shaders"] = shader_list(stats);
}

Json options_of(const FrameOptions& o) {
    Json displays = Json::array();
    for (const FrameOptions::Display& d : o.displays) {
        displays.push_back({{"name", d.name}, {"type", d.type}, {"mode", d.mode}});
    }
    return {{"resolution", o.resolution},
            {"pixel_aspect", o.pixel_aspect},
            {"crop", o.crop},
            {"samples", o.samples},
            {"filter", {{"name", o.filter}, {"width", o.filter_width}}},
            {"exposure", {o.gain, o.gamma}},
            {"shutter", o.shutter},
            {"projection", o.projection},
            {"hider", o.hider},
            {"displays", std::move(displays)}};
}

template <class Counts> Json by_severity(const Counts& counts) {
    Json out = Json::object();
    for (std::size_t i = 0; i < counts.size(); ++i) {
        out[std::string(base::severity_name(static_cast<base::Severity>(i)))] = counts[i];
    }
    return out;
}

Json frame_json(const FrameRecord& frame) {
    Json out = {{"file", frame.file},
                {"frame", frame.is_numbered ? Json(frame.number) : Json()},
                {"result", frame.result},
                {"options", options_of(frame.options)},
                {"messages", by_severity(frame.num_messages)}};
    add_stats(out, frame.stats);
    return out;
}

Json message_list(const RunRecord& run) {
    Json out = Json::array();
    for (const base::MessageRecord& m : run.messages) {
        out.push_back({{"severity", base::severity_name(m.severity)},
                       {"code", base::code_name(m.code)},
                       {"text", m.text},
                       {"count", m.count},
                       {"places", m.places}});
    }
    return out;
}

} // namespace

std::string run_json(const RunRecord& run) {
    Json out = {{"schema", "perigee-statistics"},
                {"version", statistics_version},
                {"program", {{"name", renderer_name}, {"version", renderer_version_text}}},
                {"machine",
                 {{"processor", run.machine.processor},
                  {"system", run.machine.system},
                  {"threads", run.machine.num_threads},
                  {"memory_bytes", run.machine.memory_bytes}}},
                {"arguments", run.arguments},
                {"files", run.files},
                {"elapsed_seconds", run.seconds}};
    Json total = Json::object();
    add_stats(total, run.total);
    out["total"] = std::move(total);
    Json frames = Json::array();
    for (const FrameRecord& frame : run.frames) {
        frames.push_back(frame_json(frame));
    }
    out["frames"] = std::move(frames);
    out["messages"] = message_list(run);
    return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string listing_json(const ShaderListing& listing) {
    Json shaders = Json::array();
    for (const ShaderListing::Shader& shader : listing.shaders()) {
        Json lines = Json::array();
        for (const ShaderListing::File& file : shader.files) {
            for (const auto& [number, line] : file.lines) {
                const auto at = static_cast<std::size_t>(number);
                const auto packets = static_cast<double>(line.packets);
                lines.push_back(
                    {{"file", file.name},
                     {"line", number},
                     {"seconds", line.seconds},
                     {"share", shader.seconds > 0 ? line.seconds / shader.seconds : 0},
                     {"packets", line.packets},
                     {"lanes", line.lanes},
                     {"mean_live_lanes",
                      packets > 0 ? static_cast<double>(line.lanes) / packets : 0},
                     {"text", at > 0 && at <= file.text.size() ? file.text[at - 1] : ""}});
            }
        }
        shaders.push_back({{"name", shader.name},
                           {"type", shader.type},
                           {"seconds", shader.seconds},
                           {"executions", shader.executions},
                           {"lines", std::move(lines)}});
    }
    const Json out = {{"schema", "perigee-shader-profile"},
                      {"version", 1},
                      {"seconds", listing.seconds()},
                      {"shaders", std::move(shaders)}};
    return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace trace
