// SPDX-License-Identifier: Apache-2.0
// Packets to tev, read back field by field as its Ipc.h documents them, and a viewer of our own
// that rebuilds the picture from what arrives.
#include "tracer/live_tev.h"

#include <arpa/inet.h>
#include <bit>
#include <cstring>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

namespace {

// A packet, taken apart from the front.
class Reader {
public:
    explicit Reader(std::string_view bytes) : bytes_(bytes) {}

    template <class T> T number() {
        std::uint64_t bits = 0;
        for (std::size_t i = 0; i < sizeof(T); ++i) {
            bits |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes_.at(i))) << 8 * i;
        }
        bytes_.remove_prefix(sizeof(T));
        if constexpr (std::is_same_v<T, float>) {
            return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
        } else {
            return static_cast<T>(bits);
        }
    }
    std::string text() {
        const std::size_t end = bytes_.find('\0');
        std::string out(bytes_.substr(0, end));
        bytes_.remove_prefix(end + 1);
        return out;
    }
    std::vector<std::string> texts(int count) {
        std::vector<std::string> out;
        for (int i = 0; i < count; ++i) {
            out.push_back(text());
        }
        return out;
    }
    [[nodiscard]] std::size_t left() const { return bytes_.size(); }

private:
    std::string_view bytes_;
};

const std::vector<std::string> rgba = {"R", "G", "B", "A"};

TEST(TevPackets, CreateImage) {
    const std::string packet = trace::tev::create_image(std::string("a b\0c", 5), 640, 480);
    Reader r(packet);
    EXPECT_EQ(r.number<std::uint32_t>(), packet.size());
    EXPECT_EQ(r.number<std::uint8_t>(), 4); // type
    EXPECT_EQ(r.number<std::uint8_t>(), 0); // focus stays
    EXPECT_EQ(r.text(), "a b");
    EXPECT_EQ(r.number<std::int32_t>(), 640);
    EXPECT_EQ(r.number<std::int32_t>(), 480);
    EXPECT_EQ(r.number<std::int32_t>(), 4);
    EXPECT_EQ(r.texts(4), rgba);
    EXPECT_EQ(r.left(), 0U);
}

TEST(TevPackets, UpdateImage) {
    const std::vector<float> values = {1, 2, 3, 4, -5, 6e9f, 0, 0.5f};
    const std::string packet = trace::tev::update_image("n", 300, -2, 2, 1, values);
    Reader r(packet);
    EXPECT_EQ(r.number<std::uint32_t>(), packet.size());
    EXPECT_EQ(r.number<std::uint8_t>(), 6); // version 3: with offsets and strides
    EXPECT_EQ(r.number<std::uint8_t>(), 0);
    EXPECT_EQ(r.text(), "n");
    EXPECT_EQ(r.number<std::int32_t>(), 4);
    EXPECT_EQ(r.texts(4), rgba);
    for (const int expected : {300, -2, 2, 1}) {
        EXPECT_EQ(r.number<std::int32_t>(), expected);
    }
    for (const std::int64_t expected : {0, 1, 2, 3, 4, 4, 4, 4}) {
        EXPECT_EQ(r.number<std::int64_t>(), expected);
    }
    for (const float expected : values) {
        EXPECT_EQ(r.number<float>(), expected);
    }
    EXPECT_EQ(r.left(), 0U);
}

// --- the connection

class Viewer {
public:
    Viewer() : listening_(::socket(AF_INET, SOCK_STREAM, 0)) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        EXPECT_EQ(::bind(listening_, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
        EXPECT_EQ(::listen(listening_, 1), 0);
        socklen_t size = sizeof address;
        ::getsockname(listening_, reinterpret_cast<sockaddr*>(&address), &size);
        address_.port = std::to_string(ntohs(address.sin_port));
    }
    ~Viewer() {
        hang_up();
        ::close(listening_);
    }
    [[nodiscard]] const trace::TevAddress& address() const { return address_; }
    void accept() { connection_ = ::accept(listening_, nullptr, nullptr); }
    void hang_up() {
        if (connection_ >= 0) {
            ::close(connection_);
        }
        connection_ = -1;
    }
    // The next packet, "" at the end.
    std::string packet() {
        std::string bytes = receive(4);
        if (bytes.size() < 4) {
            return {};
        }
        const auto size = Reader(bytes).number<std::uint32_t>();
        return bytes + receive(size - 4);
    }

private:
    std::string receive(std::size_t count) {
        std::string bytes(count, '\0');
        const ssize_t got = ::recv(connection_, bytes.data(), count, MSG_WAITALL);
        bytes.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
        return bytes;
    }

    int listening_, connection_ = -1;
    trace::TevAddress address_;
};

trace::LiveFrame frame() {
    trace::LiveFrame f;
    f.name = "p";
    f.number = 7;
    f.pixels = {4, 8, 6, 9};
    return f;
}

trace::Image picture(float value) {
    trace::Image image;
    image.pixels = frame().pixels;
    for (auto& plane : image.planes) {
        plane.assign(image.pixels.area(), value);
    }
    return image;
}

TEST(TevLink, NobodyThere) {
    trace::LiveView view;
    std::string error;
    EXPECT_EQ(trace::TevLink::connect(view, {"127.0.0.1", "1"}, error), nullptr);
    EXPECT_FALSE(error.empty());
    EXPECT_EQ(trace::TevLink::connect(view, {"127.0.0.1", "no such port"}, error), nullptr);
}

TEST(TevLink, SendsWhatIsThereAndWhatComes) {
    Viewer viewer;
    trace::LiveView view;
    ASSERT_TRUE(view.begin_frame(frame(), 1));
    view.bucket_done(0, frame().pixels, picture(0.5f));
    std::string error;
    const auto link = trace::TevLink::connect(view, viewer.address(), error);
    ASSERT_NE(link, nullptr) << error;
    viewer.accept();
    EXPECT_EQ(viewer.packet(), trace::tev::create_image("p frame 7", 2, 1));
    EXPECT_EQ(viewer.packet(),
              trace::tev::update_image("p frame 7", 0, 0, 2, 1, std::vector<float>(8, 0.5f)));
    view.show_final(picture(0.75f));
    EXPECT_EQ(viewer.packet(),
              trace::tev::update_image("p frame 7", 0, 0, 2, 1, std::vector<float>(8, 0.75f)));
    while (!link->is_done()) {
        std::this_thread::yield();
    }
    EXPECT_FALSE(link->is_gone());
}

// A viewer that takes nothing holds up neither the renderer nor the end.
TEST(TevLink, AStalledViewerIsLeftAlone) {
    Viewer viewer;
    trace::LiveView view;
    std::string error;
    auto link = trace::TevLink::connect(view, viewer.address(), error);
    ASSERT_NE(link, nullptr) << error;
    trace::LiveFrame large = frame();
    large.pixels = {0, 0, 1024, 1024}; // 16 MB: more than socket buffers hold
    trace::Image image;
    image.pixels = large.pixels;
    for (auto& plane : image.planes) {
        plane.assign(image.pixels.area(), 1.0f);
    }
    ASSERT_TRUE(view.begin_frame(large, 1));
    view.bucket_done(0, large.pixels, image);
    EXPECT_FALSE(link->is_done());
    link.reset();
}

TEST(TevLink, AViewerThatLeavesIsNoticed) {
    Viewer viewer;
    trace::LiveView view;
    std::string error;
    const auto link = trace::TevLink::connect(view, viewer.address(), error);
    ASSERT_NE(link, nullptr) << error;
    viewer.accept();
    viewer.hang_up();
    ASSERT_TRUE(view.begin_frame(frame(), 1));
    float value = 0;
    while (!link->is_gone()) { // the first packets after the end may still be taken
        view.bucket_done(0, frame().pixels, picture(++value));
        std::this_thread::yield();
    }
    EXPECT_TRUE(link->is_done());
}

} // namespace
