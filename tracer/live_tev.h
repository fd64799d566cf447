// SPDX-License-Identifier: Apache-2.0
// The viewer tev (github.com/Tom94/tev) shows the picture through its network protocol.
//
// In: a LiveView, the address tev listens at. A thread of its own sends what changed, in float, as
// an OpenEXR file would hold it; when tev is slow, buckets that changed twice meanwhile go out
// once. The packets follow the layout that tev documents in its Ipc.h: u32 size of the whole
// packet, u8 type, then fields of that type, integers little-endian, text ended by a zero byte.
#pragma once

#include "tracer/live_view.h"

#include <atomic>
#include <memory>
#include <string>
#include <string_view>
#include <thread>

namespace trace {

namespace tev {

// An empty RGBA picture; replaces one of the same name.
[[nodiscard]] std::string create_image(std::string_view name, int width, int height);
// Pixels x.. y.. of it, RGBA after RGBA, row by row: width * height * 4 floats.
[[nodiscard]] std::string update_image(std::string_view name, int x, int y, int width, int height,
                                       const std::vector<float>& rgba);

} // namespace tev

struct TevAddress {
    std::string host = "127.0.0.1";
    std::string port = "14158"; // where tev listens unless told otherwise
};

class TevLink {
public:
    // nullptr: nobody listens there (error says why).
    static std::unique_ptr<TevLink> connect(const LiveView& view, const TevAddress& address,
                                            std::string& error);
    ~TevLink(); // ends at once, whatever is unsent
    TevLink(const TevLink&) = delete;
    TevLink& operator=(const TevLink&) = delete;

    // Everything there is now is sent, or the viewer is gone.
    [[nodiscard]] bool is_done() const;
    [[nodiscard]] bool is_gone() const { return gone_; }

private:
    TevLink(const LiveView& view, int socket);
    void run();
    bool send_changes(LiveMark& mark);
    bool send(std::string_view bytes);

    const LiveView& view_;
    int socket_;
    std::atomic<bool> stop_{false}, gone_{false};
    mutable std::mutex mutex_;
    LiveMark sent_; // guarded by mutex_
    std::thread thread_;
};

} // namespace trace
