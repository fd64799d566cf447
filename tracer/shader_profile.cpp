// SPDX-License-Identifier: Apache-2.0
#include "tracer/shader_profile.h"

#include "runtime/base/file.h"
#include "runtime/base/ticks.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>

namespace trace {

namespace {

constexpr const char* type_names[] = {"surface", "displacement", "light",
                                      "volume",  "imager",       "transformation"};

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines(1);
    for (const char c : text) {
        if (c == '\n') {
            lines.emplace_back();
        } else if (c != '\r') {
            lines.back() += c;
        }
    }
    return lines;
}

ShaderListing::File& file_of(ShaderListing::Shader& shader, const std::string& name) {
    const auto it = std::find_if(shader.files.begin(), shader.files.end(),
                                 [&](const ShaderListing::File& f) { return f.name == name; });
    return it != shader.files.end() ? *it
                                    : shader.files.emplace_back(ShaderListing::File{name, {}, {}});
}

void print(std::string& out, const char* format, ...) __attribute__((format(printf, 2, 3)));
void print(std::string& out, const char* format, ...) {
    char buffer[256];
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(buffer, sizeof buffer, format, arguments);
    va_end(arguments);
    out += buffer;
}

double percent(double part, double whole) {
    return whole > 0 ? 100 * part / whole : 0;
}

// share, time per execution, executions, mean live lanes, as columns; blanks for a line nothing
// came to.
void print_counts(std::string& out, const ShaderListing::Line* line, double all_seconds) {
    if (line == nullptr || line->packets == 0) {
        print(out, "%38s", "");
        return;
    }
    const auto packets = static_cast<double>(line->packets);
    print(out, "%6.1f %% %9.1f %11llu %6.2f  ", percent(line->seconds, all_seconds),
          1e9 * line->seconds / packets, static_cast<unsigned long long>(line->packets),
          static_cast<double>(line->lanes) / packets);
}

void print_file(std::string& out, const ShaderListing::File& file, double all_seconds) {
    out += "  " + file.name + (file.text.empty() ? " (source not found)" : "") + "\n";
    out += "    share   ns/time       times  lanes   line\n";
    const auto at = [&](int number) {
        const auto it = file.lines.find(number);
        return it == file.lines.end() ? nullptr : &it->second;
    };
    if (const ShaderListing::Line* around = at(0)) {
        print_counts(out, around, all_seconds);
        out += "        (loads and stores)\n";
    }
    const int last = file.lines.empty() ? 0 : file.lines.rbegin()->first;
    const int end = std::max(last, static_cast<int>(file.text.size()));
    for (int number = 1; number <= end; ++number) {
        const bool has_text = number <= static_cast<int>(file.text.size());
        if (!has_text && at(number) == nullptr) {
            continue;
        }
        print_counts(out, at(number), all_seconds);
        print(out, "%6d", number);
        out += has_text ? "  " + file.text[static_cast<std::size_t>(number) - 1] + "\n" : "\n";
    }
}

} // namespace

// The shortest of many pairs: what else the processor does only adds time.
double ticks_of_stamp() {
    constexpr int stamps = 1000;
    std::uint64_t best = ~std::uint64_t{0};
    for (int attempt = 0; attempt < 8; ++attempt) {
        const std::uint64_t start = base::ticks();
        for (int i = 0; i < stamps; ++i) {
            asm volatile("" ::: "memory");
            (void)base::ticks();
        }
        best = std::min(best, base::ticks() - start);
    }
    return static_cast<double>(best) / stamps;
}

sl_profile_row* ShaderProfile::rows(const sl_object& object) {
    if (object.num_places <= 0) {
        return nullptr;
    }
    std::vector<sl_profile_row>& rows = rows_[&object];
    rows.resize(static_cast<std::size_t>(object.num_places));
    return rows.data();
}

void ShaderProfile::add(const ShaderProfile& other) {
    for (const auto& [object, rows] : other.rows_) {
        sl_profile_row* to = this->rows(*object);
        for (std::size_t i = 0; i < rows.size(); ++i) {
            to[i].ticks += rows[i].ticks;
            to[i].packets += rows[i].packets;
            to[i].lanes += rows[i].lanes;
        }
    }
}

void ShaderListing::add(const ShaderProfile& profile, double seconds_per_tick) {
    const double stamp = ticks_of_stamp();
    for (const auto& [object, rows] : profile.rows_) {
        Shader& shader = shaders_[{type_names[object->type], object->name}];
        shader.name = object->name;
        shader.type = type_names[object->type];
        shader.executions += rows[0].packets / 2; // before and after
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const sl_place& place = object->places[i];
            Line& line = file_of(shader, place.file).lines[place.line];
            const double own =
                static_cast<double>(rows[i].ticks) - stamp * static_cast<double>(rows[i].packets);
            line.number = place.line;
            line.seconds += std::max(own, 0.0) * seconds_per_tick;
            line.packets += rows[i].packets;
            line.lanes += rows[i].lanes;
            shader.seconds += std::max(own, 0.0) * seconds_per_tick;
        }
    }
}

void ShaderListing::find_sources(const std::vector<std::string>& directories) {
    for (auto& [key, shader] : shaders_) {
        for (File& file : shader.files) {
            for (const std::string& directory : directories) {
                const auto text =
                    file.text.empty() ? base::read_file(directory + "/" + file.name) : std::nullopt;
                file.text = text ? lines_of(*text) : file.text;
            }
        }
    }
}

std::vector<ShaderListing::Shader> ShaderListing::shaders() const {
    std::vector<Shader> all;
    for (const auto& [key, shader] : shaders_) {
        all.push_back(shader);
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const Shader& a, const Shader& b) { return a.seconds > b.seconds; });
    return all;
}

double ShaderListing::seconds() const {
    double sum = 0;
    for (const auto& [key, shader] : shaders_) {
        sum += shader.seconds;
    }
    return sum;
}

std::string listing_text(const ShaderListing& listing) {
    std::string out;
    for (const ShaderListing::Shader& shader : listing.shaders()) {
        out += shader.type + " " + shader.name;
        print(out, ": %.3f s, %.1f %% of all shaders, run for %llu packets\n", shader.seconds,
              percent(shader.seconds, listing.seconds()),
              static_cast<unsigned long long>(shader.executions));
        for (const ShaderListing::File& file : shader.files) {
            print_file(out, file, shader.seconds);
        }
        out += "\n";
    }
    return out;
}

} // namespace trace
