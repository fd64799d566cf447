// SPDX-License-Identifier: Apache-2.0
// Colour spaces, sl.md 4.4, and strings, 4.5.
#include "runtime/base/pattern.h"
#include "slc/interp_value.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace slc {

namespace {

using Args = std::vector<Value>&;

// By the case table of the reference.
Triple3 rgb_of_hsv(const Triple3& c) {
    const double h6 = 6 * (c[0] - std::floor(c[0]));
    const int i = static_cast<int>(h6) % 6;
    const double f = h6 - std::floor(h6);
    const double v = c[2];
    const double p = v * (1 - c[1]);
    const double q = v * (1 - c[1] * f);
    const double t = v * (1 - c[1] * (1 - f));
    const Triple3 cases[] = {{v, t, p}, {q, v, p}, {p, v, t}, {p, q, v}, {t, p, v}, {v, p, q}};
    return cases[i];
}

double hue_of(const Triple3& c, double largest, double range) {
    if (range <= 0) {
        return 0;
    }
    const double h = c[0] == largest   ? (c[1] - c[2]) / range
                     : c[1] == largest ? 2 + (c[2] - c[0]) / range
                                       : 4 + (c[0] - c[1]) / range;
    return h < 0 ? h / 6 + 1 : h / 6;
}

Triple3 hsv_of_rgb(const Triple3& c) {
    const double v = std::max({c[0], c[1], c[2]});
    const double range = v - std::min({c[0], c[1], c[2]});
    return {hue_of(c, v, range), v == 0 ? 0 : range / v, v};
}

double hsl_channel(double m1, double m2, double h) {
    h -= std::floor(h);
    if (h < 1.0 / 6) {
        return m1 + (m2 - m1) * 6 * h;
    }
    if (h < 0.5) {
        return m2;
    }
    return h < 2.0 / 3 ? m1 + (m2 - m1) * (2.0 / 3 - h) * 6 : m1;
}

Triple3 rgb_of_hsl(const Triple3& c) {
    const double s = c[1];
    const double l = c[2];
    const double m2 = l <= 0.5 ? l * (1 + s) : l + s - l * s;
    const double m1 = 2 * l - m2;
    return {hsl_channel(m1, m2, c[0] + 1.0 / 3), hsl_channel(m1, m2, c[0]),
            hsl_channel(m1, m2, c[0] - 1.0 / 3)};
}

Triple3 hsl_of_rgb(const Triple3& c) {
    const double largest = std::max({c[0], c[1], c[2]});
    const double least = std::min({c[0], c[1], c[2]});
    const double l = (largest + least) / 2;
    const double range = largest - least;
    const double d = l < 0.5 ? largest + least : 2 - largest - least;
    return {hue_of(c, largest, range), range <= 0 || d == 0 ? 0 : range / d, l};
}

Triple3 apply(const double (&m)[9], const Triple3& c) {
    return {m[0] * c[0] + m[1] * c[1] + m[2] * c[2], m[3] * c[0] + m[4] * c[1] + m[5] * c[2],
            m[6] * c[0] + m[7] * c[1] + m[8] * c[2]};
}

constexpr double rgb_of_xyz_matrix[9] = {3.24079, -1.53715, -.498535, -.969256, 1.875992,
                                         .041556, .055648,  -.204043, 1.057311};

// The other direction is the inverse of the matrix above, by cofactors.
Triple3 xyz_of_rgb(const Triple3& c) {
    const auto& m = rgb_of_xyz_matrix;
    const Triple3 r0{m[0], m[1], m[2]};
    const Triple3 r1{m[3], m[4], m[5]};
    const Triple3 r2{m[6], m[7], m[8]};
    const Triple3 c0 = cross3(r1, r2);
    const Triple3 c1 = cross3(r2, r0);
    const Triple3 c2 = cross3(r0, r1);
    const double d = dot3(r0, c0);
    Triple3 out{};
    for (std::size_t i = 0; i < 3; ++i) {
        out[i] = (c0[i] * c[0] + c1[i] * c[1] + c2[i] * c[2]) / d;
    }
    return out;
}

Triple3 to_rgb(std::string_view space, const Triple3& c) {
    if (space == "hsv") {
        return rgb_of_hsv(c);
    }
    if (space == "hsl") {
        return rgb_of_hsl(c);
    }
    if (space == "YIQ") {
        return {c[0] + .956 * c[1] + .620 * c[2], c[0] - .272 * c[1] - .647 * c[2],
                c[0] - 1.108 * c[1] + 1.705 * c[2]};
    }
    if (space == "xyz" || space == "XYZ" || space == "CIE") {
        return apply(rgb_of_xyz_matrix, c);
    }
    if (space == "xyY") {
        const double y = c[1];
        return y == 0
                   ? Triple3{0, 0, 0}
                   : apply(rgb_of_xyz_matrix, {c[0] * c[2] / y, c[2], (1 - c[0] - y) * c[2] / y});
    }
    return c;
}

Triple3 from_rgb(std::string_view space, const Triple3& c) {
    if (space == "hsv") {
        return hsv_of_rgb(c);
    }
    if (space == "hsl") {
        return hsl_of_rgb(c);
    }
    if (space == "YIQ") {
        constexpr double m[9] = {.299, .587, .114, .596, -.275, -.321, .212, -.523, .311};
        return apply(m, c);
    }
    if (space == "xyz" || space == "XYZ" || space == "CIE") {
        return xyz_of_rgb(c);
    }
    if (space == "xyY") {
        const Triple3 xyz = xyz_of_rgb(c);
        const double sum = xyz[0] + xyz[1] + xyz[2];
        return sum == 0 ? Triple3{0, 0, 0} : Triple3{xyz[0] / sum, xyz[1] / sum, xyz[1]};
    }
    return c;
}

void match(Args a, Value& r) {
    r.x[0] = base::Pattern(a[0].text()).matches(a[1].text()) ? 1 : 0;
}

void put(Value& r, const Triple3& v) {
    r.x.assign(v.begin(), v.end());
}

std::string one_value(const std::string& flags, bool integer, const Value& v) {
    char field[512];
    std::string out;
    for (const std::string& s : v.s) {
        out += out.empty() ? "" : " ";
        out += s;
    }
    for (std::size_t i = 0; i < v.x.size(); ++i) {
        if (integer) {
            std::snprintf(field, sizeof field, (flags + "lld").c_str(),
                          static_cast<long long>(v.x[i]));
        } else {
            std::snprintf(field, sizeof field, (flags + "f").c_str(), v.x[i]);
        }
        out += i > 0 ? " " : "";
        out += field;
    }
    return out;
}

} // namespace

Triple3 color_transform(std::string_view from, std::string_view to, const Triple3& c) {
    return from_rgb(to, to_rgb(from, c));
}

std::string format_text(const std::string& format, const Value* values, std::size_t n) {
    std::string out;
    std::size_t next = 0;
    for (std::size_t i = 0; i < format.size(); ++i) {
        if (format[i] != '%') {
            out += format[i];
            continue;
        }
        std::size_t end = i + 1;
        while (end < format.size() &&
               std::string_view("-+ 0#.123456789").find(format[end]) != std::string_view::npos) {
            ++end;
        }
        const char letter = end < format.size() ? format[end] : '%';
        if (std::string_view("fdpvncmsgei").find(letter) == std::string_view::npos) {
            out += '%';
            i += letter == '%' && end == i + 1 ? 1 : 0;
            continue;
        }
        const bool short_field = end - i <= 6; // an oracle needs no hundred-digit fields
        if (next < n && short_field) {
            out +=
                one_value(format.substr(i, end - i), letter == 'd' || letter == 'i', values[next]);
        }
        ++next;
        i = end;
    }
    return out;
}

std::vector<PureEntry> pure_text() {
    return {
        {"ctransform_to",
         [](Args a, Value& r) { put(r, color_transform("rgb", a[0].text(), a[1].triple())); }},
        {"ctransform_from_to",
         [](Args a, Value& r) {
             put(r, color_transform(a[0].text(), a[1].text(), a[2].triple()));
         }},
        {"match", match},
        {"arraylength",
         [](Args a, Value& r) {
             const std::size_t parts = a[0].type == Type::String ? a[0].s.size() : a[0].x.size();
             r.x[0] = static_cast<double>(parts) / num_components(a[0].type);
         }},
    };
}

} // namespace slc
