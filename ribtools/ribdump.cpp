// SPDX-License-Identifier: Apache-2.0
// ribdump [--quiet] [--list] [file.rib... | -]: reads RIB and prints what the scenes became, or,
// with --quiet, one line of counts per world; --list prints the request table. For tests and for
// looking.
#include "ribtools/reader.h"
#include "ribtools/request.h"
#include "ribtools/scene_dump.h"

#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

namespace {

class Printer final : public rib::Backend {
public:
    explicit Printer(bool quiet) : quiet_(quiet) {}

    bool render(std::unique_ptr<rib::Scene> scene) override {
        if (quiet_) {
            std::printf(
                "world: %zu primitives, %zu instances, %zu objects, %zu attributes, %zu shaders, "
                "%zu lights, %zu transforms\n",
                scene->primitives.size(), scene->instances.size(), scene->objects.size(),
                scene->attributes.size(), scene->shaders.size(), scene->lights.size(),
                scene->transforms.size());
        } else {
            std::fputs(rib::dump(*scene).c_str(), stdout);
        }
        return true;
    }
    bool make_texture(const rib::TextureRequest& request) override {
        std::printf("%s %s\n", request.kind.c_str(),
                    request.files.empty() ? "" : request.files[0].c_str());
        return true;
    }

private:
    bool quiet_;
};

void list_requests() {
    for (const rib::RequestRow& r : rib::request_table()) {
        std::printf("%-28.*s %-12.*s %.*s\n", static_cast<int>(r.name.size()), r.name.data(),
                    static_cast<int>(r.args.size()), r.args.data(),
                    static_cast<int>(r.arg_names.size()), r.arg_names.data());
    }
}

} // namespace

int main(int argc, char** argv) {
    bool quiet = false;
    std::vector<std::string> files;
    for (int i = 1; i < argc; ++i) {
        const std::string_view arg = argv[i];
        if (arg == "--quiet") {
            quiet = true;
        } else if (arg == "--list") {
            list_requests();
            return 0;
        } else {
            files.emplace_back(arg);
        }
    }
    if (files.empty()) {
        files.emplace_back("-");
    }
    base::Diag diag;
    Printer printer(quiet);
    rib::Reader reader(printer, diag, {});
    for (const std::string& file : files) {
        if (reader.read_file(file) == rib::ReadStatus::Environment) {
            return 3;
        }
    }
    return diag.had_errors() ? 1 : 0;
}
