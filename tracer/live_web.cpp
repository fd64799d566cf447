// SPDX-License-Identifier: Apache-2.0
#include "tracer/live_web.h"

#include "tracer/display_format.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstring>
#include <sys/random.h>
#include <thread>

namespace trace {

namespace {

// The file live_page.html.
constexpr std::string_view page_html =
#include "live_page.inc"
    ;

constexpr double wait_s = 1;                                 // then the clock on the page moves on
constexpr auto gather = std::chrono::milliseconds(60);       // changes that go out together
constexpr std::size_t pixels_at_once = std::size_t{1} << 18; // 5 MB
constexpr double here_s = 3; // a page that did not ask for so long is gone
constexpr std::size_t max_pages = 64, max_id = 40;

double steady_seconds() {
    using namespace std::chrono;
    return duration<double>(steady_clock::now().time_since_epoch()).count();
}

HttpReply refuse(int status, const char* text) {
    return {status, "text/plain; charset=utf-8", text};
}

// A page of another site whose name was made to point here is not let in.
bool is_local_name(std::string_view host) {
    const bool bracketed = host.starts_with('[');
    const std::string_view name = host.substr(0, bracketed ? host.find(']') + 1 : host.find(':'));
    return name == "127.0.0.1" || name == "localhost" || name == "[::1]";
}

std::uint32_t number(const std::string& text) {
    std::uint32_t value = 0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
}

LiveMark mark_of(const HttpRequest& request) {
    return {number(request.value("frame")), number(request.value("change")),
            number(request.value("status"))};
}

// --- the text part of an update

std::string_view state_name(LiveState state) {
    switch (state) {
    case LiveState::Waiting:
        return "waiting";
    case LiveState::Rendering:
        return "rendering";
    case LiveState::Done:
        return "done";
    case LiveState::Stopped:
        return "stopped";
    }
    return "";
}

std::string json_text(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') {
            out += '\\';
            out += c;
        } else if (static_cast<unsigned char>(c) < 0x20) {
            char escape[8];
            std::snprintf(escape, sizeof escape, "\\u%04x", static_cast<unsigned>(c));
            out += escape;
        } else {
            out += c;
        }
    }
    return out + '"';
}

// One JSON object, member by member.
class Json {
public:
    Json& text(std::string_view key, std::string_view value) { return raw(key, json_text(value)); }
    Json& boolean(std::string_view key, bool value) { return raw(key, value ? "true" : "false"); }
    template <class T> Json& integer(std::string_view key, T value) {
        return raw(key, std::to_string(value));
    }
    Json& real(std::string_view key, double value) {
        char digits[32];
        std::snprintf(digits, sizeof digits, "%.6g", std::isfinite(value) ? value : 0);
        return raw(key, digits);
    }
    Json& raw(std::string_view key, std::string_view value) {
        text_ += text_.empty() ? '{' : ',';
        text_ += json_text(key);
        text_ += ':';
        text_ += value;
        return *this;
    }
    [[nodiscard]] std::string finish() const { return text_ + "}"; }

private:
    std::string text_;
};

std::string tiles_json(const LiveUpdate& update) {
    std::string out;
    const PixelRange& whole = update.frame.pixels;
    for (const LiveTile& tile : update.tiles) {
        const PixelRange& p = tile.pixels;
        out += out.empty() ? "[[" : ",[";
        for (const int value : {p.x0 - whole.x0, p.y0 - whole.y0, p.width(), p.height()}) {
            out += std::to_string(value) + ",";
        }
        out += tile.final ? "1]" : "0]";
    }
    return out.empty() ? "[]" : out + "]";
}

std::string update_json(const LiveUpdate& update) {
    const LiveFrame& f = update.frame;
    Json json;
    json.text("name", f.name).integer("number", f.number);
    json.integer("x0", f.pixels.x0).integer("y0", f.pixels.y0);
    json.integer("width", f.pixels.width()).integer("height", f.pixels.height());
    json.real("gamma", static_cast<double>(f.exposure.gamma));
    json.boolean("float", f.color.storage() == Storage::Float).real("one", f.color.one);
    json.text("state", state_name(update.state)).boolean("closing", update.closing);
    json.integer("done", update.num_done).integer("total", update.num_buckets);
    json.real("elapsed", update.elapsed_s).real("left", update.left_s);
    json.boolean("restart", update.restart);
    json.integer("frame", update.mark.frame).integer("change", update.mark.change);
    json.integer("status", update.mark.status);
    return json.raw("tiles", tiles_json(update)).finish();
}

void put_u32(std::string& out, std::size_t value) {
    for (unsigned byte = 0; byte < 4; ++byte) {
        out += static_cast<char>(value >> (8 * byte) & 0xff);
    }
}

} // namespace

std::string random_token() {
    unsigned char bytes[16] = {};
    for (std::size_t have = 0; have < sizeof bytes;) {
        const ssize_t count = ::getrandom(bytes + have, sizeof bytes - have, 0);
        have += count > 0 ? static_cast<std::size_t>(count) : 0;
    }
    std::string text;
    for (const unsigned char byte : bytes) {
        char digits[3];
        std::snprintf(digits, sizeof digits, "%02x", static_cast<unsigned>(byte));
        text += digits;
    }
    return text;
}

// --- levels

ShownLevels::ShownLevels(const Quantizer& color, const Quantizer& alpha)
    : quantizers_{color, alpha}, levels_{Levels(color), Levels(alpha)} {}

char ShownLevels::level(float value, int px, int py, std::size_t channel) const {
    constexpr Plane planes[] = {Plane::R, Plane::G, Plane::B, Plane::A};
    const std::size_t which = channel == 3 ? 1 : 0;
    const Quantizer& q = quantizers_[which];
    double shown = 0;
    if (q.storage() == Storage::Float) { // linear light; alpha is not light
        const double v = value > 0 ? static_cast<double>(std::min(value, 1.0f)) : 0;
        shown = which == 1 ? v : v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
    } else {
        const float noise = dither_noise(px, py, static_cast<int>(planes[channel]));
        const auto file_level = static_cast<double>(levels_[which](value, noise));
        shown = q.one == q.zero ? 0 : (file_level - q.zero) / (q.one - q.zero);
    }
    return static_cast<char>(std::lround(std::clamp(shown, 0.0, 1.0) * 255));
}

void ShownLevels::put(const LiveTile& tile, std::string& out) const {
    std::size_t i = 0;
    for (int y = tile.pixels.y0; y < tile.pixels.y1; ++y) {
        for (int x = tile.pixels.x0; x < tile.pixels.x1; ++x) {
            for (std::size_t c = 0; c < 4; ++c) {
                out += level(tile.rgba[i++], x, y, c);
            }
        }
    }
}

// --- requests

HttpReply LiveWeb::answer(const HttpRequest& request) {
    if (!is_local_name(request.host)) {
        return refuse(403, "ask for 127.0.0.1 or localhost\n");
    }
    const std::string folder = "/" + token_ + "/";
    if (!request.path.starts_with(folder)) {
        return refuse(404, "not here; the address that render printed is needed whole\n");
    }
    const std::string name = request.path.substr(folder.size());
    if (name.empty()) {
        return {200, "text/html; charset=utf-8", std::string(page_html)};
    }
    if (name == "update") {
        return update(request);
    }
    return name == "picture.png" ? picture() : refuse(404, "not here\n");
}

void LiveWeb::note_page(const std::string& id, const LiveMark& mark) {
    if (id.empty() || id.size() > max_id) {
        return;
    }
    const double now = steady_seconds();
    const std::lock_guard lock(mutex_);
    std::erase_if(pages_, [&](const auto& page) { return now - page.second.asked_s > 2 * here_s; });
    if (pages_.size() < max_pages || pages_.contains(id)) {
        ever_ += pages_.contains(id) ? 0 : 1;
        pages_[id] = {mark, now};
    }
}

LiveWeb::Audience LiveWeb::audience() const {
    const double now = steady_seconds();
    const LiveMark newest = view_.newest();
    const std::lock_guard lock(mutex_);
    Audience audience;
    audience.ever = ever_;
    for (const auto& [id, page] : pages_) {
        if (now - page.asked_s <= here_s) {
            ++audience.now;
            audience.up_to_date += page.mark == newest ? 1 : 0;
        }
    }
    return audience;
}

HttpReply LiveWeb::update(const HttpRequest& request) {
    const LiveMark mark = mark_of(request);
    note_page(request.value("page"), mark);
    if (mark.frame != 0 && !view_.closing() && view_.wait(mark, wait_s)) {
        std::this_thread::sleep_for(gather);
    }
    const LiveUpdate update = view_.read(mark, pixels_at_once);
    if (update.closing) { // it will not ask again
        const std::lock_guard lock(mutex_);
        pages_.erase(request.value("page"));
    }
    std::string json = update_json(update);
    json.resize((json.size() + 3) / 4 * 4, ' '); // what follows is aligned
    std::string body;
    put_u32(body, json.size());
    body += json;
    const ShownLevels levels(update.frame.color, update.frame.alpha);
    for (const LiveTile& tile : update.tiles) {
        levels.put(tile, body);
        body.append(reinterpret_cast<const char*>(tile.rgba.data()),
                    tile.rgba.size() * sizeof(float));
    }
    return {200, "application/octet-stream", std::move(body)};
}

// As the page shows it: premultiplied color over black.
HttpReply LiveWeb::picture() const {
    LiveUpdate update = view_.read({}, max_live_pixels);
    const PixelRange& whole = update.frame.pixels;
    const ShownLevels levels(update.frame.color, update.frame.alpha);
    std::vector<unsigned char> rgb(whole.area() * 3);
    for (const LiveTile& tile : update.tiles) {
        std::string shown;
        levels.put(tile, shown);
        const char* from = shown.data();
        for (int y = tile.pixels.y0; y < tile.pixels.y1; ++y) {
            std::size_t to =
                (static_cast<std::size_t>(y - whole.y0) * static_cast<std::size_t>(whole.width()) +
                 static_cast<std::size_t>(tile.pixels.x0 - whole.x0)) *
                3;
            for (int x = tile.pixels.x0; x < tile.pixels.x1; ++x, from += 4, to += 3) {
                std::memcpy(&rgb[to], from, 3);
            }
        }
    }
    std::string png = encode_png(whole.width(), whole.height(), rgb);
    return png.empty() ? refuse(404, "no picture yet\n")
                       : HttpReply{200, "image/png", std::move(png)};
}

} // namespace trace
