// SPDX-License-Identifier: Apache-2.0
// What --check-energy says: a table, and errors that name shader, parameters, angle and factor.
#include "tracer/energy_check.h"
#include "tracer/shader_set.h"

#include <algorithm>
#include <cstdio>
#include <string_view>

namespace trace {

namespace {

std::string number(double value, const char* format = "%.3f") {
    char text[64];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

// "Ka=1 Kd=0.5 color=(1, 0.5, 0)": numbers that are the same at every point.
std::string parameters_text(const ShaderEntry& shader) {
    const sl_object& object = shader.object();
    const auto& block = shader.instance->params();
    std::string text;
    for (int i = 0; i < object.num_params; ++i) {
        const sl_param& param = object.params[i];
        const bool is_float = param.type == SL_TYPE_float, is_color = param.type == SL_TYPE_color;
        if (param.detail != SL_DETAIL_uniform || param.array_length != 0 ||
            !(is_float || is_color)) {
            continue;
        }
        const auto* values = reinterpret_cast<const float*>(block.data() + param.offset);
        text += std::string(text.empty() ? "" : " ") + param.name + "=";
        const auto value = [&](int k) { return number(static_cast<double>(values[k]), "%g"); };
        text += is_float ? value(0) : "(" + value(0) + ", " + value(1) + ", " + value(2) + ")";
    }
    return text;
}

std::string row_text(std::string_view label, const std::vector<EnergyShare>& shares) {
    std::string text = "  " + std::string(label);
    text.resize(16, ' ');
    for (const EnergyShare& share : shares) {
        std::string cell = number(share.value) + (share.is_too_much() ? "!" : "");
        cell.insert(0, cell.size() < 10 ? 10 - cell.size() : 1, ' ');
        text += cell;
    }
    return text + "\n";
}

const EnergyShare* worst(const std::vector<EnergyShare>& shares) {
    const auto it = std::ranges::max_element(shares, {}, &EnergyShare::value);
    return it != shares.end() && it->is_too_much() ? &*it : nullptr;
}

void report_share(const EnergyRow& row, const EnergyShare& share, std::string_view what,
                  base::Diag& diag) {
    static constexpr const char* channels[] = {"red", "green", "blue"};
    diag.report(base::Severity::Error, base::Code::Consistency, row.shader->pos,
                "surface \"" + row.shader->name + "\" returns " + number(share.value) + " (+-" +
                    number(share.standard_error) + ") times the " + std::string(what) + " at " +
                    number(static_cast<double>(share.angle_deg), "%g") +
                    " degrees from its normal, in " + channels[share.channel] + "; " +
                    parameters_text(*row.shader));
}

} // namespace

std::string energy_text(const std::vector<EnergyRow>& rows) {
    std::string text = "share of the light that surfaces return, by angle (degrees); ! marks more "
                       "than they get\n";
    for (const EnergyRow& row : rows) {
        text += row.shader->name + ": " + std::to_string(row.num_places) + " places; " +
                parameters_text(*row.shader) + "\n";
        std::string angles = "  degrees";
        angles.resize(16, ' ');
        for (const EnergyShare& share : row.by_light) {
            std::string cell = number(static_cast<double>(share.angle_deg), "%g");
            cell.insert(0, 10 - cell.size(), ' ');
            angles += cell;
        }
        text += angles + "\n" + row_text("lights", row.by_light) +
                row_text("surroundings", row.by_surroundings);
    }
    return text;
}

void report_energy(const std::vector<EnergyRow>& rows, base::Diag& diag) {
    for (const EnergyRow& row : rows) {
        if (const EnergyShare* share = worst(row.by_light)) {
            report_share(row, *share, "light that comes", diag);
        }
        if (const EnergyShare* share = worst(row.by_surroundings)) {
            report_share(row, *share, "light of even surroundings, seen", diag);
        }
    }
}

} // namespace trace
