// SPDX-License-Identifier: Apache-2.0
// Runs a case at every width and insists on the same bits; measures errors in units of the last
// place; keeps the list of bodies that some test expects a value of.
#pragma once

#include "runtime/lib/test/lanes_api.h"

#include <functional>
#include <set>
#include <string>
#include <vector>

namespace lanes_test {

using Planes = std::vector<std::vector<float>>; // one per component, all of the same length

// One way to run bodies: an archive, and which world.
struct Width {
    const lanes_api* api;
    bool uniform;
    const char* name;
};

// All this processor can run; the first is uniform values of the baseline archive.
const std::vector<Width>& widths();

// Results of one width. Lanes of batches: `batch` may be nullptr.
Planes run(const Width& width, const std::string& case_name, const Planes& in, std::size_t n,
           const sl_batch* batch = nullptr);

// Results that all widths agree on (a test failure is recorded where they do not; any NaN equals
// any other). before, if given, is called ahead of each run (to tell an engine the lanes).
Planes run_all(const std::string& case_name, const Planes& in, std::size_t n,
               const sl_batch* batch = nullptr,
               const std::function<void(const Width&)>& before = {});

// One component of run_all.
std::vector<float> run_plane(std::size_t component, const std::string& case_name, const Planes& in,
                             std::size_t n, const sl_batch* batch = nullptr);

// |got - want| in units of the last place of float at want (of the smallest normal float below it).
double ulps(float got, double want);

// Declares that a test checks these bodies: static const Covers covers{"printf", ...};
struct Covers {
    Covers(std::initializer_list<const char*> bodies);
};
const std::set<std::string>& covered();

// n values spread evenly (and in order) over [low, high].
std::vector<float> sweep(double low, double high, std::size_t n);
// n values in [low, high], decorrelated between different `dimension`s: fractional parts of
// multiples of irrationals.
std::vector<float> scatter(double low, double high, std::size_t n, int dimension);

} // namespace lanes_test
