// SPDX-License-Identifier: Apache-2.0
// Shared by the tests of ribtools: reads RIB from a string, keeps the scenes and the messages.
#pragma once

#include "ribtools/reader.h"

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace rib_test {

class Collector final : public rib::Backend {
public:
    bool render(std::unique_ptr<rib::Scene> scene) override {
        scenes.push_back(std::move(scene));
        return keep_going;
    }
    bool make_texture(const rib::TextureRequest& request) override {
        textures.push_back(request);
        return true;
    }

    bool keep_going = true;
    std::vector<std::unique_ptr<rib::Scene>> scenes;
    std::vector<rib::TextureRequest> textures;
};

// One run over one text.
class Reading {
public:
    explicit Reading(const std::string& text, rib::Config config = {})
        : null_(std::fopen("/dev/null", "w")), diag_(null_) {
        rib::Reader reader(backend, diag_, std::move(config));
        status = reader.read_text(text, "test.rib");
        messages = diag_.messages();
    }
    ~Reading() { std::fclose(null_); }
    Reading(const Reading&) = delete;
    Reading& operator=(const Reading&) = delete;

    // The last world; the test fails to run without one.
    [[nodiscard]] const rib::Scene& scene() const { return *backend.scenes.back(); }
    [[nodiscard]] base::Code code() const { return diag_.last_code(); }
    // All messages in one text, for a look at what went wrong.
    [[nodiscard]] std::string said() const {
        std::string all;
        for (const std::string& m : messages) {
            all += m + "\n";
        }
        return all;
    }
    [[nodiscard]] bool said(std::string_view part) const {
        return said().find(part) != std::string::npos;
    }

    Collector backend;
    rib::ReadStatus status = rib::ReadStatus::Ok;
    std::vector<std::string> messages;

private:
    std::FILE* null_;
    base::Diag diag_;
};

// Inside a world.
[[nodiscard]] inline std::string world(const std::string& body) {
    return "WorldBegin\n" + body + "\nWorldEnd\n";
}

} // namespace rib_test
