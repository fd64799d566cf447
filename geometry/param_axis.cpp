// SPDX-License-Identifier: Apache-2.0
#include "geometry/param_axis.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace geo {

namespace {

using Need = ParamAxis::Need;

struct Interval {
    double lo, hi, spacing;
};

// Cuts [0, 1] where needs begin and end.
std::vector<Interval> cut(std::span<const Need> needs) {
    struct Event {
        double at, spacing;
        bool begins;
    };
    std::vector<Event> events;
    for (const Need& n : needs) {
        if (n.spacing < n.hi - n.lo) {
            events.push_back({n.lo, n.spacing, true});
            events.push_back({n.hi, n.spacing, false});
        } else { // ends count all the same
            events.push_back({n.lo, 1, true});
            events.push_back({n.hi, 1, false});
        }
    }
    std::sort(events.begin(), events.end(),
              [](const Event& a, const Event& b) { return a.at < b.at; });
    std::vector<Interval> out;
    std::multiset<double> open;
    double from = 0;
    for (const Event& e : events) {
        if (e.at > from) {
            out.push_back({from, e.at, open.empty() ? 1 : *open.begin()});
            from = e.at;
        }
        if (e.begins) {
            open.insert(e.spacing);
        } else {
            open.erase(open.find(e.spacing));
        }
    }
    if (from < 1) {
        out.push_back({from, 1, 1});
    }
    return out;
}

int segments_of(const Interval& i, double stretch) {
    // A hair of slack: 1 / (1/3) must be 3.
    return std::max(1, static_cast<int>(std::ceil((i.hi - i.lo) / (i.spacing * stretch) - 1e-9)));
}

} // namespace

ParamAxis ParamAxis::covering(std::span<const Need> needs, int max_segments) {
    const std::vector<Interval> intervals = cut(needs);
    const auto total = [&](double stretch) {
        double sum = 0;
        for (const Interval& i : intervals) {
            sum += segments_of(i, stretch);
        }
        return sum;
    };
    double stretch = 1;
    const auto limit = std::max<double>(max_segments, static_cast<double>(intervals.size()));
    while (total(stretch) > limit) {
        stretch *= 1.05;
    }
    ParamAxis axis;
    auto runs = std::make_shared<std::vector<Run>>();
    axis.segments_ = 0;
    for (const Interval& i : intervals) {
        runs->push_back({i.lo, i.hi, axis.segments_, segments_of(i, stretch)});
        axis.segments_ += runs->back().segments;
    }
    if (runs->size() > 1) {
        axis.runs_ = std::move(runs);
    }
    return axis;
}

ParamAxis::Run ParamAxis::run_of_vertex(double vertex) const {
    if (!runs_) {
        return whole();
    }
    const auto it = std::upper_bound(runs_->begin(), runs_->end(), vertex,
                                     [](double k, const Run& r) { return k < r.first; });
    return it == runs_->begin() ? *it : *std::prev(it);
}

ParamAxis::Run ParamAxis::run_of_parameter(double parameter) const {
    if (!runs_) {
        return whole();
    }
    const auto it = std::upper_bound(runs_->begin(), runs_->end(), parameter,
                                     [](double s, const Run& r) { return s < r.lo; });
    return it == runs_->begin() ? *it : *std::prev(it);
}

double ParamAxis::vertex(int k) const {
    if (k >= segments_) {
        return 1;
    }
    const Run r = run_of_vertex(k);
    return r.lo + (r.hi - r.lo) * (k - r.first) / r.segments;
}

int ParamAxis::nearest(double parameter) const {
    const Run r = run_of_parameter(parameter);
    const double k = r.first + std::floor((parameter - r.lo) / (r.hi - r.lo) * r.segments + 0.5);
    return static_cast<int>(std::clamp(k, 0.0, static_cast<double>(segments_)));
}

double ParamAxis::parameter(double position) const {
    if (!runs_) {
        return position;
    }
    const double k = position * segments_;
    const Run r = run_of_vertex(k);
    return r.lo + (r.hi - r.lo) * (k - r.first) / r.segments;
}

double ParamAxis::position(double parameter) const {
    if (!runs_) {
        return parameter;
    }
    const Run r = run_of_parameter(parameter);
    return (r.first + (parameter - r.lo) / (r.hi - r.lo) * r.segments) / segments_;
}

double ParamAxis::spacing(double parameter) const {
    const Run r = run_of_parameter(parameter);
    return (r.hi - r.lo) / r.segments;
}

double ParamAxis::longest_segment(double lo, double hi) const {
    if (!runs_) {
        return 1.0 / segments_;
    }
    double longest = 0;
    for (const Run& r : *runs_) {
        if (r.lo < hi && r.hi > lo) {
            longest = std::max(longest, (r.hi - r.lo) / r.segments);
        }
    }
    return longest;
}

void ParamAxis::append_needs(std::vector<Need>& out) const {
    if (!runs_) {
        out.push_back({0, 1, 1.0 / segments_});
        return;
    }
    for (const Run& r : *runs_) {
        out.push_back({r.lo, r.hi, (r.hi - r.lo) / r.segments});
    }
}

std::size_t ParamAxis::heap_bytes() const {
    return runs_ ? runs_->capacity() * sizeof(Run) + 64 : 0;
}

} // namespace geo
