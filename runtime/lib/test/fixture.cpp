// SPDX-License-Identifier: Apache-2.0
// See fixture.h.
#include "runtime/lib/test/fixture.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <gtest/gtest.h>

namespace lanes_test {

const std::vector<Width>& widths() {
    static const std::vector<Width> all = [] {
        std::vector<Width> w{{&lanes_api_4, true, "uniform"}, {&lanes_api_4, false, "4 lanes"}};
        if (__builtin_cpu_supports("avx2")) {
            w.push_back({&lanes_api_8, true, "uniform, AVX2"});
            w.push_back({&lanes_api_8, false, "8 lanes"});
        }
        return w;
    }();
    return all;
}

namespace {

int find_case(const lanes_api& api, const std::string& name) {
    for (int i = 0; i < api.num_cases; i++)
        if (name == api.cases[i].name)
            return i;
    return -1;
}

bool same_bits(float a, float b) {
    return (std::isnan(a) && std::isnan(b)) ||
           std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

std::set<std::string>& covered_bodies() {
    static std::set<std::string> bodies;
    return bodies;
}

} // namespace

Planes run(const Width& width, const std::string& case_name, const Planes& in, std::size_t n,
           const sl_batch* batch) {
    const int k = find_case(*width.api, case_name);
    EXPECT_GE(k, 0) << "no case " << case_name;
    if (k < 0)
        return {};
    const lanes_case& row = width.api->cases[k];
    EXPECT_EQ(in.size(), static_cast<std::size_t>(row.num_in)) << case_name;
    const std::size_t padded = (n + 7) / 8 * 8;
    Planes args = in, out(static_cast<std::size_t>(row.num_out), std::vector<float>(padded));
    std::vector<const float*> in_planes;
    std::vector<float*> out_planes;
    for (auto& plane : args) {
        plane.resize(padded, plane.empty() ? 0.0f : plane.back());
        in_planes.push_back(plane.data());
    }
    for (auto& plane : out)
        out_planes.push_back(plane.data());
    width.api->run(k, width.uniform, batch, in_planes.data(), out_planes.data(),
                   static_cast<int>(n));
    for (auto& plane : out)
        plane.resize(n);
    return out;
}

Planes run_all(const std::string& case_name, const Planes& in, std::size_t n, const sl_batch* batch,
               const std::function<void(const Width&)>& before) {
    Planes first;
    for (const Width& width : widths()) {
        if (before)
            before(width);
        Planes here = run(width, case_name, in, n, batch);
        if (first.empty()) {
            first = std::move(here);
            continue;
        }
        for (std::size_t k = 0; k < first.size() && k < here.size(); k++)
            for (std::size_t i = 0; i < n; i++) {
                if (same_bits(here[k][i], first[k][i]))
                    continue;
                ADD_FAILURE() << case_name << ": " << width.name << " gives " << here[k][i]
                              << ", uniform " << first[k][i] << " (component " << k << ", point "
                              << i << ")";
                return first;
            }
    }
    return first;
}

std::vector<float> run_plane(std::size_t component, const std::string& case_name, const Planes& in,
                             std::size_t n, const sl_batch* batch) {
    return run_all(case_name, in, n, batch)[component];
}

double ulps(float got, double want) {
    const float w = static_cast<float>(want);
    if (std::isnan(want) || std::isnan(got))
        return std::isnan(want) && std::isnan(got) ? 0 : HUGE_VAL;
    if (std::isinf(w) || std::isinf(got))
        return w == got ? 0 : HUGE_VAL;
    const int exponent = want == 0 ? -126 : std::max(std::ilogb(want), -126);
    return std::abs(static_cast<double>(got) - want) / std::ldexp(1.0, exponent - 23);
}

Covers::Covers(std::initializer_list<const char*> bodies) {
    covered_bodies().insert(bodies.begin(), bodies.end());
}

const std::set<std::string>& covered() {
    return covered_bodies();
}

std::vector<float> sweep(double low, double high, std::size_t n) {
    std::vector<float> v(n);
    for (std::size_t i = 0; i < n; i++)
        v[i] = static_cast<float>(low + (high - low) * static_cast<double>(i) /
                                            static_cast<double>(n > 1 ? n - 1 : 1));
    return v;
}

std::vector<float> scatter(double low, double high, std::size_t n, int dimension) {
    const double step = std::fmod(std::sqrt(2.0 + 3 * dimension) + 0.137 * dimension, 1.0);
    std::vector<float> v(n);
    for (std::size_t i = 0; i < n; i++)
        v[i] = static_cast<float>(
            low + (high - low) * std::fmod(0.5 + static_cast<double>(i + 1) * step, 1.0));
    return v;
}

} // namespace lanes_test
