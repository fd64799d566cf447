// SPDX-License-Identifier: Apache-2.0
// A small web server for this machine only: 127.0.0.1, GET, short requests. Its library is heavy,
// so the server is a module opened on first use (live_http_module.cpp); this header is what both
// sides know. A request runs on its connection's own thread and may wait; no exception leaves the
// module.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace trace {

struct HttpRequest {
    std::string path; // decoded, without the query
    std::string host; // the header
    std::vector<std::pair<std::string, std::string>> query;

    // "" if it is not there.
    [[nodiscard]] const std::string& value(const std::string& name) const {
        static const std::string none;
        for (const auto& [key, text] : query) {
            if (key == name) {
                return text;
            }
        }
        return none;
    }
};

struct HttpReply {
    int status = 200;
    std::string type; // Content-Type
    std::string body;
};

// Called from several threads at a time.
using HttpHandler = std::function<HttpReply(const HttpRequest& request)>;

class HttpServer {
public:
    virtual ~HttpServer() = default; // waits for replies under way, a moment
    [[nodiscard]] virtual int port() const = 0;
};

// Listens at the port, any free one for 0. nullptr: error says why.
[[nodiscard]] std::unique_ptr<HttpServer> start_http(int port, HttpHandler handler,
                                                     std::string& error);

// What the module exports under http_module_start: the server, owned by the caller, or null.
using HttpModuleStart = HttpServer* (*)(int port, HttpHandler* handler, std::string* error);
constexpr const char* http_module_name = "perigee_http";
constexpr const char* http_module_start = "perigee_http_start";

} // namespace trace
