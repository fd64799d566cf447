// SPDX-License-Identifier: Apache-2.0
#include "tracer/live_tev.h"

#include <array>
#include <bit>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace trace {

// --- packets

namespace tev {

namespace {

enum class Type : std::uint8_t { CreateImage = 4, UpdateImageV3 = 6 };
constexpr std::array<std::string_view, 4> channels = {"R", "G", "B", "A"};

class Packet {
public:
    explicit Packet(Type type) {
        integer<std::uint32_t>(0); // the size, known at the end
        integer(static_cast<std::uint8_t>(type));
        integer<std::uint8_t>(0); // does not take the focus
    }

    template <class T> void integer(T value) {
        using U = std::make_unsigned_t<T>;
        for (std::size_t byte = 0; byte < sizeof(T); ++byte) {
            bytes_ += static_cast<char>(static_cast<U>(value) >> (8 * byte) & 0xff);
        }
    }

    // A zero byte inside would end it early.
    void text(std::string_view value) {
        bytes_ += value.substr(0, value.find('\0'));
        bytes_ += '\0';
    }

    void floats(const std::vector<float>& values) {
        static_assert(std::endian::native == std::endian::little, "tev reads floats as they are");
        bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
    }

    void channel_names() {
        integer(static_cast<std::int32_t>(channels.size()));
        for (const std::string_view name : channels) {
            text(name);
        }
    }

    std::string finish() {
        std::string size;
        size.swap(bytes_);
        integer(static_cast<std::uint32_t>(size.size()));
        size.replace(0, sizeof(std::uint32_t), bytes_);
        return size;
    }

private:
    std::string bytes_;
};

} // namespace

std::string create_image(std::string_view name, int width, int height) {
    Packet packet(Type::CreateImage);
    packet.text(name);
    packet.integer(std::int32_t{width});
    packet.integer(std::int32_t{height});
    packet.channel_names();
    return packet.finish();
}

std::string update_image(std::string_view name, int x, int y, int width, int height,
                         const std::vector<float>& rgba) {
    Packet packet(Type::UpdateImageV3);
    packet.text(name);
    packet.channel_names();
    for (const int value : {x, y, width, height}) {
        packet.integer(std::int32_t{value});
    }
    for (std::size_t c = 0; c < channels.size(); ++c) { // where a channel begins, in floats
        packet.integer(static_cast<std::int64_t>(c));
    }
    for (std::size_t c = 0; c < channels.size(); ++c) { // from pixel to pixel
        packet.integer(static_cast<std::int64_t>(channels.size()));
    }
    packet.floats(rgba);
    return packet.finish();
}

} // namespace tev

// --- the connection

namespace {

constexpr int connect_timeout_ms = 2000;
constexpr int poll_interval_ms = 100; // how soon a stop is noticed
constexpr double wait_s = 0.2;
constexpr std::size_t pixels_at_once = std::size_t{1} << 16;

// A connected, non-blocking socket, or -1.
int connect_one(const addrinfo& address, std::string& error) {
    const int fd = ::socket(address.ai_family, address.ai_socktype | SOCK_CLOEXEC | SOCK_NONBLOCK,
                            address.ai_protocol);
    if (fd < 0) {
        error = std::strerror(errno);
        return -1;
    }
    int failure = ::connect(fd, address.ai_addr, address.ai_addrlen) == 0 ? 0 : errno;
    if (failure == EINPROGRESS) {
        pollfd waiting{fd, POLLOUT, 0};
        const bool answered = ::poll(&waiting, 1, connect_timeout_ms) > 0;
        socklen_t size = sizeof failure;
        failure = ETIMEDOUT;
        if (answered) {
            ::getsockopt(fd, SOL_SOCKET, SO_ERROR, &failure, &size);
        }
    }
    if (failure == 0) {
        return fd;
    }
    error = std::strerror(failure);
    ::close(fd);
    return -1;
}

// The name in the viewer's list; frames of one animation stand beside each other.
std::string shown_name(const LiveFrame& frame) {
    return frame.number > 0 ? frame.name + " frame " + std::to_string(frame.number) : frame.name;
}

} // namespace

std::unique_ptr<TevLink> TevLink::connect(const LiveView& view, const TevAddress& address,
                                          std::string& error) {
    addrinfo hints{};
    hints.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    if (const int code = ::getaddrinfo(address.host.c_str(), address.port.c_str(), &hints, &found);
        code != 0) {
        error = ::gai_strerror(code);
        return nullptr;
    }
    int fd = -1;
    for (const addrinfo* a = found; a != nullptr && fd < 0; a = a->ai_next) {
        fd = connect_one(*a, error);
    }
    ::freeaddrinfo(found);
    return fd < 0 ? nullptr : std::unique_ptr<TevLink>(new TevLink(view, fd));
}

TevLink::TevLink(const LiveView& view, int socket)
    : view_(view), socket_(socket), thread_([this] { run(); }) {}

TevLink::~TevLink() {
    stop_ = true;
    thread_.join();
    ::close(socket_);
}

bool TevLink::is_done() const {
    const std::lock_guard lock(mutex_);
    return gone_ || sent_ == view_.newest();
}

void TevLink::run() {
    LiveMark mark;
    while (!stop_ && !gone_) {
        if (view_.wait(mark, wait_s) && !send_changes(mark)) {
            gone_ = true;
        }
    }
}

bool TevLink::send_changes(LiveMark& mark) {
    const LiveUpdate update = view_.read(mark, pixels_at_once);
    const std::string name = shown_name(update.frame);
    const PixelRange& whole = update.frame.pixels;
    if (update.restart && !send(tev::create_image(name, whole.width(), whole.height()))) {
        return false;
    }
    for (const LiveTile& tile : update.tiles) {
        const PixelRange& p = tile.pixels;
        if (!send(tev::update_image(name, p.x0 - whole.x0, p.y0 - whole.y0, p.width(), p.height(),
                                    tile.rgba))) {
            return false;
        }
    }
    mark = update.mark;
    const std::lock_guard lock(mutex_);
    sent_ = mark;
    return true;
}

// False: stopped, or the viewer is gone.
bool TevLink::send(std::string_view bytes) {
    while (!bytes.empty() && !stop_) {
        const ssize_t count = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (count >= 0) {
            bytes.remove_prefix(static_cast<std::size_t>(count));
            continue;
        }
        if (errno == EAGAIN || errno == EWOULDBLOCK) {
            pollfd waiting{socket_, POLLOUT, 0};
            ::poll(&waiting, 1, poll_interval_ms);
        } else if (errno != EINTR) {
            return false;
        }
    }
    return bytes.empty();
}

} // namespace trace
