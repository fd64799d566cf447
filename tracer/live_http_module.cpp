// SPDX-License-Identifier: Apache-2.0
// The module perigee_http: HttpServer on libmicrohttpd. Bounds of what strangers can take: the
// memory of a request, the number of connections, idle time. A request has no body; whatever its
// path says, only the handler sees it.
#include "tracer/live_http.h"

#include <arpa/inet.h>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <exception>
#include <microhttpd.h>
#include <thread>

namespace trace {

namespace {

constexpr unsigned max_connections = 48;
constexpr std::size_t request_bytes = 16 * 1024;
constexpr unsigned idle_s = 20;
constexpr std::size_t max_query = 16;
constexpr auto last_replies = std::chrono::seconds(2); // granted to replies under way at the end

class Server : public HttpServer {
public:
    explicit Server(HttpHandler handler) : handler_(std::move(handler)) {}
    ~Server() override;

    bool start(int port, std::string& error);
    [[nodiscard]] int port() const override { return port_; }

private:
    static MHD_Result on_request(void* self, MHD_Connection* connection, const char* path,
                                 const char* method, const char* version, const char* upload,
                                 std::size_t* upload_size, void** request);
    static void on_completed(void* self, MHD_Connection* connection, void** request,
                             MHD_RequestTerminationCode how);
    MHD_Result answer(MHD_Connection* connection, const char* path, bool is_get);
    [[nodiscard]] HttpReply reply_to(MHD_Connection* connection, const char* path) const;

    HttpHandler handler_;
    MHD_Daemon* daemon_ = nullptr;
    int port_ = 0;
    std::atomic<int> under_way_{0};
};

MHD_Result add_argument(void* request, MHD_ValueKind, const char* key, const char* value) {
    auto& query = static_cast<HttpRequest*>(request)->query;
    query.emplace_back(key, value != nullptr ? value : "");
    return query.size() < max_query ? MHD_YES : MHD_NO; // NO ends the enumeration
}

bool Server::start(int port, std::string& error) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    errno = 0;
    daemon_ = MHD_start_daemon(
        MHD_USE_INTERNAL_POLLING_THREAD | MHD_USE_THREAD_PER_CONNECTION | MHD_USE_POLL,
        static_cast<std::uint16_t>(port), nullptr, nullptr, &on_request, this, MHD_OPTION_SOCK_ADDR,
        reinterpret_cast<sockaddr*>(&address), MHD_OPTION_CONNECTION_LIMIT, max_connections,
        MHD_OPTION_CONNECTION_MEMORY_LIMIT, request_bytes, MHD_OPTION_CONNECTION_TIMEOUT, idle_s,
        MHD_OPTION_NOTIFY_COMPLETED, &on_completed, this, MHD_OPTION_END);
    if (daemon_ == nullptr) {
        error = "cannot listen at 127.0.0.1:" + std::to_string(port) + ": " +
                (errno != 0 ? std::strerror(errno) : "the web server does not start");
        return false;
    }
    port_ = MHD_get_daemon_info(daemon_, MHD_DAEMON_INFO_BIND_PORT)->port;
    return true;
}

Server::~Server() {
    if (daemon_ == nullptr) {
        return;
    }
    const MHD_socket listening = MHD_quiesce_daemon(daemon_);
    const auto limit = std::chrono::steady_clock::now() + last_replies;
    while (under_way_ > 0 && std::chrono::steady_clock::now() < limit) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    MHD_stop_daemon(daemon_);
    if (listening != MHD_INVALID_SOCKET) {
        ::close(listening);
    }
}

MHD_Result Server::on_request(void* self, MHD_Connection* connection, const char* path,
                              const char* method, const char*, const char*,
                              std::size_t* upload_size, void** request) {
    auto& server = *static_cast<Server*>(self);
    if (*request == nullptr) { // headers only so far: the answer may come in the next call
        *request = &server;
        ++server.under_way_;
        return MHD_YES;
    }
    *upload_size = 0; // a body is not read
    return server.answer(connection, path, std::strcmp(method, MHD_HTTP_METHOD_GET) == 0);
}

void Server::on_completed(void* self, MHD_Connection*, void** request, MHD_RequestTerminationCode) {
    if (*request != nullptr) {
        --static_cast<Server*>(self)->under_way_;
        *request = nullptr;
    }
}

HttpReply Server::reply_to(MHD_Connection* connection, const char* path) const {
    try {
        HttpRequest request;
        request.path = path;
        const char* host = MHD_lookup_connection_value(connection, MHD_HEADER_KIND, "Host");
        request.host = host != nullptr ? host : "";
        MHD_get_connection_values(connection, MHD_GET_ARGUMENT_KIND, &add_argument, &request);
        return handler_(request);
    } catch (const std::exception&) {
        return {500, "text/plain", "not enough memory\n"};
    }
}

void free_body(void* body) {
    delete static_cast<std::string*>(body);
}

MHD_Result Server::answer(MHD_Connection* connection, const char* path, bool is_get) {
    HttpReply reply =
        is_get ? reply_to(connection, path) : HttpReply{405, "text/plain", "only GET\n"};
    auto* body = new std::string(std::move(reply.body));
    MHD_Response* response = MHD_create_response_from_buffer_with_free_callback_cls(
        body->size(), body->data(), &free_body, body);
    if (response == nullptr) {
        delete body;
        return MHD_NO;
    }
    MHD_add_response_header(response, "Content-Type", reply.type.c_str());
    MHD_add_response_header(response, "Cache-Control", "no-store");
    MHD_add_response_header(response, "X-Content-Type-Options", "nosniff");
    MHD_add_response_header(response, "Cross-Origin-Resource-Policy", "same-origin");
    MHD_add_response_header(response, "Referrer-Policy", "no-referrer");
    MHD_add_response_header(response, "Content-Security-Policy",
                            "default-src 'none'; script-src 'unsafe-inline'; style-src "
                            "'unsafe-inline'; connect-src 'self'; img-src 'self' data: blob:; "
                            "frame-ancestors 'none'; base-uri 'none'; form-action 'none'");
    const MHD_Result queued =
        MHD_queue_response(connection, static_cast<unsigned>(reply.status), response);
    MHD_destroy_response(response);
    return queued;
}

} // namespace

} // namespace trace

extern "C" [[gnu::visibility("default")]] trace::HttpServer*
perigee_http_start(int port, trace::HttpHandler* handler, std::string* error) {
    try {
        auto server = std::make_unique<trace::Server>(std::move(*handler));
        return server->start(port, *error) ? server.release() : nullptr;
    } catch (const std::exception& e) {
        *error = e.what();
        return nullptr;
    }
}
