// SPDX-License-Identifier: Apache-2.0
#include "tracer/develop.h"

#include "tracer/imager.h"
#include "tracer/shader_set.h"

#include <algorithm>

namespace trace {

namespace {

bool share_a_picture(const DisplayPlan& a, const DisplayPlan& b) {
    return a.exposure == b.exposure && a.picture == b.picture;
}

} // namespace

Developer::Developer(const FrameContext& frame, const ShaderEntry* imager, int num_threads,
                     Counters& counters, std::span<const DisplayPlan> plans, Image&& filtered)
    : frame_(frame), imager_(imager), num_threads_(num_threads), counters_(counters),
      picture_(std::move(filtered)) {
    const bool all_share = std::ranges::all_of(
        plans, [&](const DisplayPlan& plan) { return share_a_picture(plan, plans.front()); });
    if (!all_share) {
        filtered_ = picture_.planes;
    }
}

// Colour and opacity from the film, or from six extra channels that another filter made.
void Developer::choose_planes(int picture) {
    if (!filtered_.front().empty()) {
        picture_.planes = filtered_;
    }
    if (picture < 0) {
        return;
    }
    for (std::size_t k = 0; k < 6; ++k) {
        picture_.planes[static_cast<std::size_t>(Plane::R) + k] =
            picture_.extra[static_cast<std::size_t>(picture) + k];
    }
    const auto OR = picture_.plane(Plane::OR), OG = picture_.plane(Plane::OG),
               OB = picture_.plane(Plane::OB), A = picture_.plane(Plane::A);
    for (std::size_t i = 0; i < A.size(); ++i) {
        A[i] = (OR[i] + OG[i] + OB[i]) / 3;
    }
}

const Image& Developer::developed(const DisplayPlan& plan) {
    if (is_developed_ && plan.exposure == exposure_ && plan.picture == source_) {
        return picture_;
    }
    choose_planes(plan.picture);
    apply_exposure(picture_, plan.exposure);
    if (imager_ != nullptr) {
        // What the imager prints it prints once, whatever the number of displays.
        run_imager(frame_, *imager_, picture_, num_threads_, counters_, !is_developed_);
    }
    exposure_ = plan.exposure;
    source_ = plan.picture;
    is_developed_ = true;
    return picture_;
}

} // namespace trace
