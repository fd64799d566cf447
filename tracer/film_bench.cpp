// SPDX-License-Identifier: Apache-2.0
// What a sample costs outside tracing and shading, one thread: positions, ray, film with filter.
// Prints ns per sample and the share of a coherent raw ray's time (68 ns, as render_bench measures
// it). The goals leave 25 % of that for everything with a box filter, 54 % with gaussian 2x2.
#include "tracer/camera.h"
#include "tracer/film.h"

#include <cstdio>
#include <cstdlib>
#include <ctime>

namespace {

constexpr double raw_ray_ns = 68;

// Of this thread's processor time: other programs do not count.
double seconds() {
    timespec t{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

struct Times {
    double sampler = 0, rays = 0, buffer = 0, film = 0;
    std::size_t samples = 0;
    [[nodiscard]] double ns(double s) const { return 1e9 * s / static_cast<double>(samples); }
    [[nodiscard]] double total_ns() const { return ns(sampler + rays + buffer + film); }
};

Times measure(const char* filter, float width, int n, bool lens) {
    std::FILE* null = std::fopen("/dev/null", "w");
    base::Diag diag(null);
    rib::Scene scene;
    scene.options.projection = "perspective";
    scene.options.xres = scene.options.yres = 512;
    if (lens) {
        scene.options.fstop = 4;
        scene.options.focal_length = 1;
        scene.options.focal_distance = 5;
    }
    scene.options.xsamples = scene.options.ysamples = n;
    const trace::Camera camera(scene, diag);
    const trace::Sampler sampler(trace::sampler_settings(scene.options, diag));
    const trace::FilterWeights weights(trace::Filter(filter, width, width, diag), sampler);
    const auto film = trace::Film::create(camera.raster(), sampler, weights, {}, diag);
    Times t;
    trace::SampleBlock block;
    std::vector<geo::RayPacket> packets;
    for (std::size_t b = 0; b < film->num_buckets(); ++b) {
        const double t0 = seconds();
        sampler.fill(film->sample_pixels(b), block);
        const double t1 = seconds();
        packets.resize(block.num_packets());
        camera.make_rays(block, packets);
        const double t2 = seconds();
        trace::SampleBuffer samples = film->buffer(b);
        for (std::size_t i = 0; i < block.count; ++i) {
            samples.samples[i].color[0] = packets[i / 8].dx[i % 8];
            samples.samples[i].z = 1;
        }
        const double t3 = seconds();
        film->submit(b, std::move(samples));
        const double t4 = seconds();
        t.sampler += t1 - t0;
        t.rays += t2 - t1;
        t.buffer += t3 - t2;
        t.film += t4 - t3;
        t.samples += block.count;
    }
    std::fclose(null);
    return t;
}

} // namespace

int main() {
    const struct {
        const char* filter;
        float width;
        int n;
        bool lens;
    } rows[] = {{"box", 1, 1, false},      {"box", 1, 2, false},      {"box", 1, 4, false},
                {"gaussian", 2, 1, false}, {"gaussian", 2, 2, false}, {"gaussian", 2, 4, false},
                {"sinc", 4, 4, false},     {"gaussian", 2, 4, true}};
    std::printf("%-12s %5s %8s | %8s %8s %8s %8s | %8s %9s\n", "filter", "width", "samples",
                "positions", "rays", "buffer", "film", "ns", "of a ray");
    for (const auto& r : rows) {
        (void)measure(r.filter, r.width, r.n, r.lens); // warm caches and pages
        const Times t = measure(r.filter, r.width, r.n, r.lens);
        std::printf("%-12s %5.1f %5dx%d%s | %8.2f %8.2f %8.2f %8.2f | %8.2f %7.1f %%\n", r.filter,
                    static_cast<double>(r.width), r.n, r.n, r.lens ? "L" : " ", t.ns(t.sampler),
                    t.ns(t.rays), t.ns(t.buffer), t.ns(t.film), t.total_ns(),
                    100 * t.total_ns() / raw_ray_ns);
    }
    return EXIT_SUCCESS;
}
