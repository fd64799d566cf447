// SPDX-License-Identifier: Apache-2.0
// Shows frames while they render: -d and Display "framebuffer".
//
// In: frames from the renderer. Out: a web page on this machine, and the viewer tev where one
// listens; one line on standard error says where. What fails here is a warning; rendering never
// waits for it. When it ends is decided in finish(): live-005.
#pragma once

#include "ribtools/scene.h"
#include "runtime/base/diag.h"
#include "tracer/live_tev.h"
#include "tracer/live_view.h"
#include "tracer/live_web.h"
#include "tracer/outputs.h"

#include <cstdio>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace trace {

// Where the picture is shown: --display-server, PERIGEE_DISPLAY.
struct LiveServers {
    std::optional<int> web_port;   // 0: any free one
    std::optional<TevAddress> tev; // asked for: not reaching it is worth a warning
    bool try_tev = false;          // at its usual address, silently
};
// "auto", "none", or several of web, web:PORT, tev, HOST:PORT (a tev there), separated by commas.
// nullopt: not of that form.
[[nodiscard]] std::optional<LiveServers> parse_live_servers(std::string_view text);
constexpr std::string_view live_servers_form = "auto | none | web[:PORT],tev,HOST:PORT";

struct LiveSettings {
    bool every_frame = false;  // -d
    bool framebuffers = false; // frames with a framebuffer display
    int every = 1;             // every Nth row of buckets first
    LiveServers servers;
    bool on_terminal = false; // somebody can read the address and press Ctrl-C
};

class LiveDisplay {
public:
    LiveDisplay(LiveSettings settings, base::Diag& diag, std::FILE* out = stderr);
    ~LiveDisplay();

    // Opens page and viewer and says where they are; once.
    void start();
    [[nodiscard]] const LiveSettings& settings() const { return settings_; }
    [[nodiscard]] const std::string& address() const { return address_; } // of the page

    // Which of the displays is shown; null: the frame is not.
    [[nodiscard]] const DisplayPlan* shown(std::span<const DisplayPlan> displays) const;
    // The observer for the film; null: not shown after all.
    FilmObserver* begin_frame(const DisplayPlan& plan, const rib::Options& options,
                              const PixelRange& pixels, std::size_t num_buckets);
    void show_final(const Image& developed); // of the running frame
    void end_frame(bool complete);

    // After the last frame: returns when nobody watches any more, or by rules that need nobody
    // (live-005).
    void finish(bool (*interrupted)());

private:
    void start_web(int port);
    void start_tev(const TevAddress& address, bool asked_for);
    void say(const std::string& text);
    void wait_for_tev(bool (*interrupted)());
    void wait_for_pages(bool (*interrupted)());

    LiveSettings settings_;
    base::Diag& diag_;
    std::FILE* out_;
    bool started_ = false, running_ = false;
    std::string address_;
    LiveView view_;
    std::unique_ptr<LiveWeb> web_;
    std::unique_ptr<HttpServer> server_; // asks web_
    std::unique_ptr<TevLink> tev_;
};

} // namespace trace
