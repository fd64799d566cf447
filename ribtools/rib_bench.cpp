// SPDX-License-Identifier: Apache-2.0
// Benchmark: how fast number-heavy RIB text is read, from memory to a finished scene, on one core.
// Prints one JSON line: megabytes (10^6) per second, best of three, with the limit it is judged by.
#include "ribtools/reader.h"

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <random>
#include <string>

namespace {

class Sink final : public rib::Backend {
public:
    bool render(std::unique_ptr<rib::Scene> scene) override {
        num_primitives += scene->primitives.size();
        return true;
    }
    bool make_texture(const rib::TextureRequest&) override { return true; }

    std::size_t num_primitives = 0;
};

// Meshes as exporters write them: eight significant digits, index arrays, a few parameters.
std::string make_text(std::size_t bytes) {
    std::mt19937 random(1);
    std::string text = "version 3.03\nWorldBegin\n";
    char number[32];
    while (text.size() < bytes) {
        constexpr int num_vertices = 20000;
        text += "PointsPolygons [";
        for (int i = 0; i < num_vertices / 2; ++i) {
            text += "4 ";
        }
        text += "]\n[";
        for (int i = 0; i < num_vertices * 2; ++i) {
            text += std::to_string(random() % num_vertices) + (i % 12 == 11 ? "\n" : " ");
        }
        text += "]\n\"P\" [";
        for (int i = 0; i < num_vertices * 3; ++i) {
            std::snprintf(number, sizeof number, "%.8g",
                          static_cast<double>(random()) / 4294967296.0 * 20 - 10);
            text += number;
            text += i % 6 == 5 ? "\n" : " ";
        }
        text += "]\n";
    }
    return text + "WorldEnd\n";
}

} // namespace

int main(int argc, char** argv) {
    const std::size_t megabytes = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 64;
    const std::string text = make_text(megabytes * 1'000'000);
    double best = 0;
    for (int i = 0; i < 3; ++i) {
        base::Diag diag;
        Sink sink;
        rib::Reader reader(sink, diag, {});
        const std::clock_t begin = std::clock(); // processor time: other programs do not count
        (void)reader.read_text(text, "generated");
        const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
        const double speed = static_cast<double>(text.size()) / 1e6 / seconds;
        best = speed > best ? speed : best;
    }
    std::printf(
        "{\"name\": \"RIB text, numbers\", \"value\": %.0f, \"unit\": \"MB/s\", \"limit\": 150, "
        "\"better\": \"higher\", \"error\": \"exact\", \"note\": \"%zu MB, one core, processor "
        "time\"}\n",
        best, megabytes);
    return 0;
}
