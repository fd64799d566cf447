// SPDX-License-Identifier: Apache-2.0
// Benchmark: how fast number-heavy RIB is read, from memory to a finished scene, and converted by
// what catrib does, on one core. Prints a JSON line each: megabytes (10^6) of input per second,
// best of three, with the limit it is judged by.
#include "ribtools/reader.h"
#include "ribtools/rib_convert.h"
#include "ribtools/rib_gzip.h"

#include <algorithm>
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

// Nothing of what is written is kept.
class CountingSink final : public rib::ByteSink {
public:
    bool write(std::string_view bytes) override {
        size += bytes.size();
        return true;
    }
    bool finish() override { return true; }
    std::string error() const override { return {}; }

    std::size_t size = 0;
};

using Stream = std::shared_ptr<const std::string>;

void read(const Stream& stream) {
    base::Diag diag;
    Sink sink;
    rib::Reader reader(sink, diag, {});
    (void)reader.read_text(*stream, "generated");
}

void convert(const Stream& stream, rib::RibForm form, rib::ByteSink& sink) {
    base::Diag diag;
    rib::Writer writer(sink, {form, 0});
    rib::Converter converter(writer, diag, {});
    (void)converter.convert(rib::open_gzip(rib::open_memory(stream)), "generated");
    writer.flush();
    (void)sink.finish();
}

template <class Work> void measure(const char* name, std::size_t bytes, int limit, Work work) {
    double best = 0;
    for (int i = 0; i < 3; ++i) {
        const std::clock_t begin = std::clock(); // processor time: other programs do not count
        work();
        const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
        best = std::max(best, static_cast<double>(bytes) / 1e6 / seconds);
    }
    std::printf("{\"name\": \"%s\", \"value\": %.0f, \"unit\": \"MB/s\", \"limit\": %d, "
                "\"better\": \"higher\", \"error\": \"exact\", \"note\": \"%zu MB, one core, "
                "processor time\"}\n",
                name, best, limit, bytes / 1'000'000);
}

} // namespace

int main(int argc, char** argv) {
    const std::size_t megabytes = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 64;
    const Stream text = std::make_shared<const std::string>(make_text(megabytes * 1'000'000));
    std::string made;
    const auto sink = rib::memory_sink(made);
    convert(text, rib::RibForm::Binary, *sink);
    const Stream binary = std::make_shared<const std::string>(std::move(made));
    using enum rib::RibForm;
    CountingSink nowhere;
    measure("RIB text, numbers", text->size(), 150, [&] { read(text); });
    measure("RIB binary, numbers", binary->size(), 150, [&] { read(binary); });
    measure("catrib, text to text", text->size(), 50, [&] { convert(text, Text, nowhere); });
    measure("catrib, text to binary", text->size(), 100, [&] { convert(text, Binary, nowhere); });
    measure("catrib, binary to text", binary->size(), 25, [&] { convert(binary, Text, nowhere); });
    measure("catrib, binary to binary", binary->size(), 100,
            [&] { convert(binary, Binary, nowhere); });
    return 0;
}
