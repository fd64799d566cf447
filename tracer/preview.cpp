// SPDX-License-Identifier: Apache-2.0
#include "tracer/preview.h"

#include "tracer/display_format.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace trace {

namespace {

using Rgba = std::array<double, 4>;

// The mean of a rectangle of pixels; colour stays premultiplied.
Rgba mean_of(const Image& image, const PixelRange& box) {
    constexpr Plane planes[] = {Plane::R, Plane::G, Plane::B, Plane::A};
    Rgba sum{};
    for (int y = box.y0; y < box.y1; ++y) {
        for (int x = box.x0; x < box.x1; ++x) {
            const auto at =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(image.pixels.width()) +
                static_cast<std::size_t>(x);
            for (std::size_t k = 0; k < 4; ++k) {
                const auto value = static_cast<double>(image.plane(planes[k])[at]);
                sum[k] += std::isfinite(value) ? value : 0;
            }
        }
    }
    for (double& value : sum) {
        value /= static_cast<double>(box.area());
    }
    return sum;
}

double srgb(double linear) { // IEC 61966-2-1
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

std::uint8_t level(double value) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(value, 0.0, 1.0)));
}

} // namespace

Preview make_preview(const Image& image, const DisplayPlan& plan) {
    Preview preview;
    const int width = image.pixels.width(), height = image.pixels.height();
    if (width == 0 || height == 0) {
        return preview;
    }
    const double scale =
        std::min(1.0, static_cast<double>(max_preview_px) / std::max(width, height));
    preview.width = std::max(1, static_cast<int>(width * scale));
    preview.height = std::max(1, static_cast<int>(height * scale));
    const auto has_role = [&](ChannelRole role) {
        return std::ranges::find(plan.channels, role, &ShownChannel::role) != plan.channels.end();
    };
    const bool has_alpha = has_role(ChannelRole::Alpha);
    const bool is_encoded =
        !plan.channels.empty() && plan.channels.front().quantizer.storage() != Storage::Float;
    std::vector<std::uint8_t> rgba;
    for (int y = 0; y < preview.height; ++y) {
        for (int x = 0; x < preview.width; ++x) {
            const auto cut = [](int i, int of, int from) {
                return static_cast<int>(static_cast<std::int64_t>(i) * from / of);
            };
            Rgba c = mean_of(image, {cut(x, preview.width, width), cut(y, preview.height, height),
                                     cut(x + 1, preview.width, width),
                                     cut(y + 1, preview.height, height)});
            const double alpha = has_alpha ? std::clamp(c[3], 0.0, 1.0) : 1;
            for (std::size_t k = 0; k < 3; ++k) {
                const double color = alpha > 0 ? c[k] / alpha : 0;
                rgba.push_back(level(is_encoded ? color : srgb(color)));
            }
            rgba.push_back(level(alpha));
        }
    }
    preview.png = encode_png(preview.width, preview.height, rgba);
    return preview;
}

} // namespace trace
