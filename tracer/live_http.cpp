// SPDX-License-Identifier: Apache-2.0
#include "tracer/live_http.h"

#include "runtime/base/module.h"

namespace trace {

std::unique_ptr<HttpServer> start_http(int port, HttpHandler handler, std::string& error) {
    const base::ModuleSymbol found = base::open_module(http_module_name, http_module_start);
    if (found.address == nullptr) {
        error = found.error;
        return nullptr;
    }
    const auto start = reinterpret_cast<HttpModuleStart>(found.address);
    return std::unique_ptr<HttpServer>(start(port, &handler, &error));
}

} // namespace trace
