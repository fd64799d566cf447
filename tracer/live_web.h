// SPDX-License-Identifier: Apache-2.0
// The web page that shows the picture while it renders: requests in, replies out.
//
// Below a secret folder (other users of the machine can reach the port too) lie the page, `update`,
// which answers when something changed since the mark in the query, and `picture.png`. Nothing of a
// request reaches the file system. The server keeps no state per page but when it last asked and
// what it had. Form of an update: docs/design/live.md, live-004.
#pragma once

#include "tracer/live_http.h"
#include "tracer/live_view.h"

#include <map>
#include <mutex>
#include <string>
#include <string_view>

namespace trace {

// 128 random bits as text, for the folder.
[[nodiscard]] std::string random_token();

class LiveWeb {
public:
    LiveWeb(const LiveView& view, std::string token) : view_(view), token_(std::move(token)) {}

    // Thread-safe; `update` waits up to a second.
    [[nodiscard]] HttpReply answer(const HttpRequest& request);

    // Pages that asked within the last seconds and were not told that nothing follows; those of
    // them that have everything.
    struct Audience {
        std::size_t ever = 0, now = 0, up_to_date = 0;
    };
    [[nodiscard]] Audience audience() const;

private:
    struct Page {
        LiveMark mark;
        double asked_s = 0;
    };
    HttpReply update(const HttpRequest& request);
    HttpReply picture() const;
    void note_page(const std::string& id, const LiveMark& mark);

    const LiveView& view_;
    const std::string token_;
    mutable std::mutex mutex_; // guards pages_ and ever_
    std::map<std::string, Page> pages_;
    std::size_t ever_ = 0;
};

// 8 bits a channel as the display's file holds them, R G B A after each other.
class ShownLevels {
public:
    ShownLevels(const Quantizer& color, const Quantizer& alpha);
    void put(const LiveTile& tile, std::string& out) const;

private:
    [[nodiscard]] char level(float value, int px, int py, std::size_t channel) const;

    Quantizer quantizers_[2]; // color, alpha
    Levels levels_[2];
};

} // namespace trace
