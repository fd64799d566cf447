// SPDX-License-Identifier: Apache-2.0
// The page's requests: what is answered, what is refused, the bytes of an update, and the server
// itself over a socket.
#include "tracer/live_web.h"

#include <arpa/inet.h>
#include <cstring>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>

namespace {

using trace::HttpReply;
using trace::HttpRequest;
using trace::LiveView;
using trace::LiveWeb;

constexpr const char* token = "secret";

HttpRequest request(std::string path, std::vector<std::pair<std::string, std::string>> query = {}) {
    return {std::move(path), "127.0.0.1:1234", std::move(query)};
}

trace::LiveFrame frame() {
    trace::LiveFrame f;
    f.name = "say \"cheese\"\n";
    f.number = 2;
    f.pixels = {4, 8, 6, 9};
    f.color.dither = f.alpha.dither = 0;
    return f;
}

void put_pixels(LiveView& view, float value) {
    trace::Image image;
    image.pixels = frame().pixels;
    for (auto& plane : image.planes) {
        plane.assign(image.pixels.area(), value);
    }
    view.bucket_done(0, image.pixels, image);
}

struct Update {
    std::string json, bytes;
};
Update parse(const HttpReply& reply) {
    std::uint32_t size = 0;
    std::memcpy(&size, reply.body.data(), 4);
    return {reply.body.substr(4, size), reply.body.substr(4 + size)};
}

TEST(LiveWeb, RefusesStrangers) {
    LiveView view;
    LiveWeb web(view, token);
    HttpRequest foreign = request("/secret/");
    foreign.host = "evil.example:1234";
    EXPECT_EQ(web.answer(foreign).status, 403);
    for (const char* host : {"", "127.0.0.1.evil.example", "[::2]:80", "localhost.example"}) {
        foreign.host = host;
        EXPECT_EQ(web.answer(foreign).status, 403) << host;
    }
    for (const char* host : {"127.0.0.1", "localhost:8080", "[::1]:80"}) {
        foreign.host = host;
        EXPECT_EQ(web.answer(foreign).status, 200) << host;
    }
    for (const char* path : {"/", "", "/secre/", "/secret", "/secret/../etc/passwd", "/secret//",
                             "/secret/live_page.html"}) {
        EXPECT_EQ(web.answer(request(path)).status, 404) << path;
    }
    EXPECT_EQ(web.answer(request("/secret/picture.png")).status, 404); // none yet
}

TEST(LiveWeb, ThePageStandsAlone) {
    LiveView view;
    LiveWeb web(view, token);
    const HttpReply page = web.answer(request("/secret/"));
    EXPECT_EQ(page.type, "text/html; charset=utf-8");
    EXPECT_TRUE(page.body.starts_with("<!DOCTYPE html>"));
    EXPECT_NE(page.body.find("</html>"), std::string::npos);
    for (const char* outside : {"http:", "https:", "src=", "@import"}) {
        EXPECT_EQ(page.body.find(outside), std::string::npos) << outside;
    }
}

TEST(LiveWeb, AnUpdateHoldsTextLevelsAndFloats) {
    LiveView view;
    LiveWeb web(view, token);
    ASSERT_TRUE(view.begin_frame(frame(), 1));
    put_pixels(view, 0.5f);
    const Update update = parse(web.answer(request("/secret/update")));
    EXPECT_NE(update.json.find(R"("name":"say \"cheese\"\u000a","number":2)"), std::string::npos)
        << update.json;
    EXPECT_NE(update.json.find(R"("tiles":[[0,0,2,1,1]])"), std::string::npos) << update.json;
    EXPECT_NE(update.json.find(R"("state":"rendering")"), std::string::npos);
    EXPECT_NE(update.json.find(R"("frame":1,"change":1,"status":1)"), std::string::npos);
    EXPECT_EQ(update.json.size() % 4, 0U);
    ASSERT_EQ(update.bytes.size(), 2U * (4 + 16));
    EXPECT_EQ(static_cast<unsigned char>(update.bytes[0]), 128); // 0.5 of 255, rounded
    float value = 0;
    std::memcpy(&value, update.bytes.data() + 8, 4);
    EXPECT_EQ(value, 0.5f);
}

TEST(LiveWeb, WaitsForNews) {
    LiveView view;
    LiveWeb web(view, token);
    ASSERT_TRUE(view.begin_frame(frame(), 1));
    std::thread later([&] { put_pixels(view, 1); });
    const HttpReply reply = web.answer(request(
        "/secret/update", {{"page", "p"}, {"frame", "1"}, {"change", "0"}, {"status", "1"}}));
    later.join();
    EXPECT_EQ(parse(reply).bytes.size(), 40U);
    // Numbers that are none count as nothing seen.
    const HttpReply again = web.answer(request(
        "/secret/update", {{"frame", "99999999999999"}, {"change", "-1"}, {"status", "x"}}));
    EXPECT_EQ(parse(again).bytes.size(), 40U);
}

TEST(LiveWeb, KnowsWhoHasThePicture) {
    LiveView view;
    LiveWeb web(view, token);
    ASSERT_TRUE(view.begin_frame(frame(), 1));
    put_pixels(view, 1);
    EXPECT_EQ(web.audience().ever, 0U);
    (void)web.answer(request("/secret/update", {{"page", "p"}}));
    EXPECT_EQ(web.audience().now, 1U);
    EXPECT_EQ(web.audience().up_to_date, 0U);
    (void)web.answer(request("/secret/update",
                             {{"page", "p"}, {"frame", "1"}, {"change", "1"}, {"status", "1"}}));
    EXPECT_EQ(web.audience().up_to_date, 1U);
    EXPECT_EQ(web.audience().ever, 1U);
    for (int i = 0; i < 1000; ++i) { // nobody fills the memory with names
        (void)web.answer(request("/secret/update", {{"page", "n" + std::to_string(i)}}));
    }
    EXPECT_LE(web.audience().now, 64U);
    const std::size_t before = web.audience().now;
    view.close();
    (void)web.answer(request("/secret/update", {{"page", "p"}}));
    EXPECT_EQ(web.audience().now, before - 1); // told: it goes
}

TEST(LiveWeb, LevelsAreThoseOfTheFile) {
    const trace::LiveTile tile{{0, 0, 1, 1}, true, {0.5f, 2.0f, -1.0f, 1.0f}};
    const auto shown = [&](const trace::Quantizer& color) {
        std::string out;
        trace::ShownLevels(color, color).put(tile, out);
        return std::vector<int>{
            static_cast<unsigned char>(out[0]), static_cast<unsigned char>(out[1]),
            static_cast<unsigned char>(out[2]), static_cast<unsigned char>(out[3])};
    };
    EXPECT_EQ(shown({0, 255, 0, 255, 0}), (std::vector<int>{128, 255, 0, 255}));
    EXPECT_EQ(shown({0, 65535, 0, 65535, 0}), (std::vector<int>{128, 255, 0, 255}));
    EXPECT_EQ(shown({0, 255, 0, 200, 0}), (std::vector<int>{128, 200, 0, 200}));
    EXPECT_EQ(shown({0, 0, 0, 0, 0}), (std::vector<int>{188, 255, 0, 255})); // float: sRGB curve
}

// --- over a socket

// Everything the server says to these bytes.
std::string ask(int port, const std::string& text) {
    const int fd = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    EXPECT_EQ(::connect(fd, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    (void)::send(fd, text.data(), text.size(), MSG_NOSIGNAL);
    std::string answer;
    char buffer[4096];
    for (ssize_t n = 0; (n = ::recv(fd, buffer, sizeof buffer, 0)) > 0;) {
        answer.append(buffer, static_cast<std::size_t>(n));
    }
    ::close(fd);
    return answer;
}

std::string get(const std::string& path) {
    return "GET " + path + " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";
}

TEST(HttpServer, AnswersAndBounds) {
    std::string error;
    HttpRequest seen;
    const auto server = trace::start_http(
        0,
        [&](const HttpRequest& r) {
            seen = r;
            return HttpReply{200, "text/plain", "hello"};
        },
        error);
    ASSERT_NE(server, nullptr) << error;
    ASSERT_GT(server->port(), 0);
    std::string answer = ask(server->port(), get("/a%20b/c?x=1&y=%26&z"));
    EXPECT_TRUE(answer.starts_with("HTTP/1.1 200")) << answer;
    EXPECT_TRUE(answer.ends_with("\r\n\r\nhello"));
    EXPECT_NE(answer.find("Content-Security-Policy: default-src 'none'"), std::string::npos);
    EXPECT_EQ(seen.path, "/a b/c");
    EXPECT_EQ(seen.host, "localhost");
    EXPECT_EQ(seen.value("x"), "1");
    EXPECT_EQ(seen.value("y"), "&");
    EXPECT_EQ(seen.value("nothing"), "");
    answer = ask(server->port(), "POST / HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n"
                                 "Content-Length: 0\r\n\r\n");
    EXPECT_TRUE(answer.starts_with("HTTP/1.1 405")) << answer;
    answer = ask(server->port(), get("/" + std::string(100'000, 'x'))); // too long: never seen
    EXPECT_FALSE(answer.starts_with("HTTP/1.1 200")) << answer.substr(0, 80);
    EXPECT_EQ(ask(server->port(), "nonsense\r\n\r\n").find("200"), std::string::npos);
}

TEST(HttpServer, PortInUse) {
    std::string error;
    const auto handler = [](const HttpRequest&) { return HttpReply{}; };
    const auto first = trace::start_http(0, handler, error);
    ASSERT_NE(first, nullptr) << error;
    EXPECT_EQ(trace::start_http(first->port(), handler, error), nullptr);
    EXPECT_NE(error.find(std::to_string(first->port())), std::string::npos) << error;
}

TEST(HttpServer, EndsWithAReplyUnderWay) {
    LiveView view;
    LiveWeb web(view, token);
    ASSERT_TRUE(view.begin_frame(frame(), 1));
    std::string error;
    auto server = trace::start_http(
        0, [&](const HttpRequest& r) { return web.answer(r); }, error);
    ASSERT_NE(server, nullptr) << error;
    std::string answer;
    std::thread page([&, port = server->port()] {
        answer = ask(port, get("/secret/update?page=p&frame=1&change=0&status=1"));
    });
    while (web.audience().now == 0) {
        std::this_thread::yield();
    }
    view.close();
    server.reset();
    page.join();
    EXPECT_NE(answer.find("\"closing\":true"), std::string::npos) << answer;
}

TEST(LiveWeb, TokensDiffer) {
    EXPECT_EQ(trace::random_token().size(), 32U);
    EXPECT_NE(trace::random_token(), trace::random_token());
}

} // namespace
