// SPDX-License-Identifier: Apache-2.0
#include "tracer/live_display.h"

#include "tracer/display.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <thread>

namespace trace {

// --- where

namespace {

std::optional<int> port_number(std::string_view text) {
    int port = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
    const bool good = error == std::errc() && end == text.data() + text.size();
    return good && port > 0 && port < 65536 ? std::optional(port) : std::nullopt;
}

// One element of the list.
bool add_server(std::string_view text, LiveServers& servers) {
    const auto colon = text.rfind(':');
    const std::string_view host = text.substr(0, colon);
    if (colon == std::string_view::npos) {
        if (text == "web") {
            servers.web_port = 0;
        } else if (text == "tev") {
            servers.tev = TevAddress{};
        }
        return text == "web" || text == "tev";
    }
    const std::optional<int> port = port_number(text.substr(colon + 1));
    if (!port || host.empty()) {
        return false;
    }
    if (host == "web") {
        servers.web_port = *port;
    } else if (host == "tev") {
        servers.tev = {TevAddress{}.host, std::to_string(*port)};
    } else {
        servers.tev = {std::string(host), std::to_string(*port)};
    }
    return true;
}

} // namespace

std::optional<LiveServers> parse_live_servers(std::string_view text) {
    LiveServers servers;
    if (text == "auto") {
        servers.web_port = 0;
        servers.try_tev = true;
        return servers;
    }
    if (text == "none") {
        return servers;
    }
    while (true) {
        const auto comma = text.find(',');
        if (!add_server(text.substr(0, comma), servers)) {
            return std::nullopt;
        }
        if (comma == std::string_view::npos) {
            return servers;
        }
        text.remove_prefix(comma + 1);
    }
}

// --- start

LiveDisplay::LiveDisplay(LiveSettings settings, base::Diag& diag, std::FILE* out)
    : settings_(std::move(settings)), diag_(diag), out_(out) {}

LiveDisplay::~LiveDisplay() {
    view_.close();
    server_.reset(); // before what it asks
}

// What -d asks for, not a message about the input: -silent does not hide it.
void LiveDisplay::say(const std::string& text) {
    std::fprintf(out_, "perigee: info: %s\n", text.c_str());
    std::fflush(out_);
}

void LiveDisplay::start_web(int port) {
    const std::string token = random_token();
    web_ = std::make_unique<LiveWeb>(view_, token);
    std::string error;
    server_ = start_http(
        port, [web = web_.get()](const HttpRequest& request) { return web->answer(request); },
        error);
    if (!server_) {
        diag_.report(base::Severity::Warning, base::Code::System, {},
                     "the picture has no web page: " + error);
        return;
    }
    address_ = "http://127.0.0.1:" + std::to_string(server_->port()) + "/" + token + "/";
    say("the picture is shown at " + address_);
}

void LiveDisplay::start_tev(const TevAddress& address, bool asked_for) {
    const std::string where = address.host + ":" + address.port;
    std::string error;
    tev_ = TevLink::connect(view_, address, error);
    if (tev_) {
        say("connected to tev at " + where);
    } else if (asked_for) {
        diag_.report(base::Severity::Warning, base::Code::System, {},
                     "no viewer at " + where + ": " + error);
    }
}

void LiveDisplay::start() {
    if (started_) {
        return;
    }
    started_ = true;
    if (settings_.servers.tev || settings_.servers.try_tev) {
        start_tev(settings_.servers.tev.value_or(TevAddress{}), settings_.servers.tev.has_value());
    }
    if (settings_.servers.web_port) {
        start_web(*settings_.servers.web_port);
    }
}

// --- frames

const DisplayPlan* LiveDisplay::shown(std::span<const DisplayPlan> displays) const {
    const auto window = std::ranges::find_if(displays, shows_window, &DisplayPlan::display);
    if (window != displays.end() && (settings_.framebuffers || settings_.every_frame)) {
        return &*window;
    }
    return settings_.every_frame && !displays.empty() ? &displays.front() : nullptr;
}

namespace {

// How the display's file holds color or alpha.
Quantizer quantizer_of(const DisplayPlan& plan, ChannelRole role, const rib::Options& options) {
    if (keeps_floats(plan.display)) {
        return {0, 0, 0, 0, 0};
    }
    const auto channel = std::ranges::find(plan.channels, role, &ShownChannel::role);
    return channel != plan.channels.end() ? channel->quantizer : quantizer(options.color_quantize);
}

} // namespace

FilmObserver* LiveDisplay::begin_frame(const DisplayPlan& plan, const rib::Options& options,
                                       const PixelRange& pixels, std::size_t num_buckets) {
    start();
    if (!server_ && !tev_) {
        return nullptr;
    }
    LiveFrame frame;
    frame.name = plan.display.name;
    frame.number = options.in_frame ? options.frame : 0;
    frame.pixels = pixels;
    frame.exposure = plan.exposure;
    frame.color = quantizer_of(plan, ChannelRole::Color, options);
    frame.alpha = quantizer_of(plan, ChannelRole::Alpha, options);
    running_ = view_.begin_frame(frame, num_buckets);
    if (!running_) {
        diag_.report_once("live-size", base::Severity::Warning, base::Code::Limit, plan.display.pos,
                          "a picture of " + std::to_string(pixels.width()) + " by " +
                              std::to_string(pixels.height()) +
                              " pixels is too large to be shown while it renders");
    }
    return running_ ? &view_ : nullptr;
}

void LiveDisplay::show_final(const Image& developed) {
    if (running_) {
        view_.show_final(developed);
    }
}

void LiveDisplay::end_frame(bool complete) {
    if (running_) {
        view_.end_frame(complete ? LiveState::Done : LiveState::Stopped);
    }
    running_ = false;
}

// --- the end

namespace {

using Clock = std::chrono::steady_clock;
constexpr auto look_again = std::chrono::milliseconds(50);
constexpr auto last_pixels = std::chrono::seconds(10); // for viewers to take the finished picture
constexpr auto first_look = std::chrono::seconds(60);  // for somebody to open the page
constexpr auto last_words = std::chrono::seconds(1);   // for pages between two requests
constexpr auto reload = std::chrono::seconds(3);       // a page that is gone may come back

} // namespace

void LiveDisplay::wait_for_tev(bool (*interrupted)()) {
    const auto limit = Clock::now() + last_pixels;
    while (tev_ && !tev_->is_done() && !interrupted() && Clock::now() < limit) {
        std::this_thread::sleep_for(look_again);
    }
    if (tev_ && (tev_->is_gone() || (!tev_->is_done() && !interrupted()))) {
        diag_.report(base::Severity::Warning, base::Code::System, {},
                     tev_->is_gone() ? "the viewer tev went away while the picture rendered"
                                     : "the viewer tev does not take the picture; it has a part");
    }
    tev_.reset();
}

void LiveDisplay::wait_for_pages(bool (*interrupted)()) {
    const bool stays = settings_.on_terminal;
    if (stays) {
        say("finished; the page stays until it is closed, or Ctrl-C is pressed here");
    }
    const auto begin = Clock::now();
    auto last_seen = begin;
    while (!interrupted()) {
        const LiveWeb::Audience audience = web_->audience();
        const auto now = Clock::now();
        last_seen = audience.now > 0 ? now : last_seen;
        const bool all_have_it = audience.up_to_date == audience.now;
        if (!stays && (all_have_it || now - begin > last_pixels)) {
            return;
        }
        if (stays && now - last_seen > (audience.ever > 0 ? reload : first_look)) {
            return;
        }
        std::this_thread::sleep_for(look_again);
    }
}

void LiveDisplay::finish(bool (*interrupted)()) {
    wait_for_tev(interrupted);
    if (server_ && !interrupted()) {
        wait_for_pages(interrupted);
    }
    view_.close();
    const auto limit = Clock::now() + last_words;
    while (server_ && web_->audience().now > 0 && Clock::now() < limit) {
        std::this_thread::sleep_for(look_again);
    }
    server_.reset();
}

} // namespace trace
