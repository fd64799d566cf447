// SPDX-License-Identifier: Apache-2.0
#include "tracer/energy_check.h"

#include "tracer/camera.h"
#include "tracer/energy_probe.h"
#include "tracer/hemisphere_samples.h"
#include "tracer/ray_packets.h"
#include "tracer/sampler.h"
#include "tracer/shader_set.h"
#include "tracer/shading_classes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>

namespace trace {

namespace {

constexpr int grid_px = 8; // between the camera rays that look for surfaces
constexpr std::size_t max_places = 6;
constexpr std::uint32_t num_views = 250; // of a batch
constexpr int num_replicas = 4;          // whose spread is the standard error
constexpr float angles_deg[] = {5, 25, 45, 60, 75, 85};
constexpr float degree = 3.14159265358979324f / 180;

using View = EnergyProbe::View;
using Response = EnergyProbe::Response;
using Sums = std::array<double, 3>;

void add(Sums& sums, const base::Color& c, double scale) {
    sums[0] += scale * static_cast<double>(c.r);
    sums[1] += scale * static_cast<double>(c.g);
    sums[2] += scale * static_cast<double>(c.b);
}

// Mean and standard error of replicas, in the channel with the largest mean.
EnergyShare share_of(const std::vector<Sums>& replicas, float angle) {
    EnergyShare share;
    share.angle_deg = angle;
    share.value = -1;
    const double n = static_cast<double>(replicas.size());
    for (std::size_t k = 0; k < 3; ++k) {
        double sum = 0, sum2 = 0;
        for (const Sums& replica : replicas) {
            sum += replica[k];
        }
        for (const Sums& replica : replicas) {
            sum2 += (replica[k] - sum / n) * (replica[k] - sum / n);
        }
        if (sum / n > share.value) {
            share.value = sum / n;
            share.standard_error = std::sqrt(sum2 / (n * std::max(n - 1, 1.0)));
            share.channel = static_cast<int>(k);
        }
    }
    return share;
}

// One place, asked again and again.
class PlaceCheck {
public:
    PlaceCheck(EnergyProbe& probe, const EnergyProbe::Place& place, std::uint32_t seed)
        : probe_(probe), place_(place), seed_(seed),
          frame_(HemisphereFrame::about(probe.normal(place.hit))) {}

    [[nodiscard]] EnergyShare by_light(float angle) const;
    [[nodiscard]] EnergyShare by_surroundings(float angle) const;

private:
    // Directions spread by the cosine over one side.
    [[nodiscard]] std::vector<View> side(float sign, SampleStream& stream) const;
    [[nodiscard]] base::V3f direction(float angle, float around) const;
    void ask(const ProbeLight& light, const std::vector<View>& views,
             std::vector<Response>& out) const {
        out.resize(views.size());
        probe_.shade(place_, light, views, out);
    }

    EnergyProbe& probe_;
    const EnergyProbe::Place& place_;
    std::uint32_t seed_;
    HemisphereFrame frame_;
};

base::V3f PlaceCheck::direction(float angle, float around) const {
    const float sine = std::sin(angle * degree);
    return frame_.from_local(sine * std::cos(around), sine * std::sin(around),
                             std::cos(angle * degree));
}

std::vector<View> PlaceCheck::side(float sign, SampleStream& stream) const {
    const HemisphereStrata strata = HemisphereStrata::of(num_views);
    const HemisphereCone cone = HemisphereCone::of(90 * degree, HemisphereDensity::Cosine);
    std::vector<View> views;
    for (std::uint32_t cell = 0; cell < strata.count(); ++cell) {
        const float x = stream.next(), y = stream.next();
        const base::V3f d = direction_in(strata, cone, cell, x, y);
        views.push_back({frame_.from_local(d.x, d.y, sign * d.z), stream.next_bits()});
    }
    return views;
}

// Light from one direction with Cl = 1 brings cos(angle); what leaves, in all directions, is the
// cosine-weighted mean of Ci. Emission, found in the dark, is not returned light.
EnergyShare PlaceCheck::by_light(float angle) const {
    std::vector<Sums> replicas;
    std::vector<Response> lit, dark;
    for (int r = 0; r < num_replicas; ++r) {
        SampleStream stream(seed_ + static_cast<std::uint32_t>(r));
        ProbeLight light;
        light.has_light = true;
        light.to_light = direction(angle, 360 * degree * stream.next());
        Sums returned{};
        for (const float sign : {1.0f, -1.0f}) {
            const std::vector<View> views = side(sign, stream);
            ask(light, views, lit);
            ask({}, views, dark);
            const double scale = 1 / (static_cast<double>(views.size()) *
                                      std::cos(static_cast<double>(angle * degree)));
            for (std::size_t i = 0; i < views.size(); ++i) {
                add(returned, lit[i].Ci - dark[i].Ci, scale);
            }
        }
        replicas.push_back(returned);
    }
    return share_of(replicas, angle);
}

// Everything around has radiance 1, seen by ambient() and by rays; what lies behind the surface
// shows through it by 1 - Oi.
EnergyShare PlaceCheck::by_surroundings(float angle) const {
    std::vector<Sums> replicas;
    std::vector<Response> lit, dark;
    const ProbeLight light{.has_light = false, .to_light = {}, .ambient = 1, .surroundings = 1};
    for (int r = 0; r < num_replicas; ++r) {
        SampleStream stream(seed_ + 77 + static_cast<std::uint32_t>(r));
        constexpr int turns = 16;
        std::vector<View> views;
        for (int i = 0; i < turns; ++i) {
            const float around = 360 * degree * (static_cast<float>(i) + stream.next()) / turns;
            views.push_back({direction(angle, around), stream.next_bits()});
        }
        ask(light, views, lit);
        ask({}, views, dark);
        Sums returned{};
        for (std::size_t i = 0; i < views.size(); ++i) {
            add(returned, lit[i].Ci - dark[i].Ci + base::Color(1) - lit[i].Oi, 1.0 / turns);
        }
        replicas.push_back(returned);
    }
    return share_of(replicas, angle);
}

// Worst place by angle.
void keep_worst(std::vector<EnergyShare>& shares, std::size_t angle, const EnergyShare& share) {
    if (angle == shares.size()) {
        shares.push_back(share);
    } else if (share.value - 3 * share.standard_error >
               shares[angle].value - 3 * shares[angle].standard_error) {
        shares[angle] = share;
    }
}

} // namespace

EnergyCheck::EnergyCheck(const FrameContext& frame, const Camera& camera,
                         const ShadingClasses& classes, ThreadState& thread)
    : frame_(frame), camera_(camera), classes_(classes), thread_(thread) {}

// Where rays of a coarse grid first meet each shader; places of one shader that come later replace
// some of the earlier ones, so that they are spread over the picture.
std::vector<EnergyCheck::Subject> EnergyCheck::find_places() const {
    std::vector<Subject> subjects;
    std::vector<std::uint32_t> seen;
    const PixelRange pixels = camera_.raster().picture;
    for (int y = pixels.y0; y < pixels.y1; y += grid_px) {
        for (int x = pixels.x0; x < pixels.x1; x += grid_px) {
            const Camera::Ray ray = camera_.pinhole_ray(x + 0.5, y + 0.5);
            geo::RayPacket packet = {};
            set_ray(packet, 0,
                    {base::V3f(ray.origin), base::V3f(ray.direction), static_cast<float>(ray.tfar),
                     frame_.spaces.shutter_open(), geo::CameraRay});
            packet.tnear[0] = static_cast<float>(ray.tnear);
            geo::Hit hits[geo::RayPacket::size];
            frame_.world->intersect(packet, hits);
            if (!hits[0].valid()) {
                continue;
            }
            const std::uint32_t state = frame_.world->binding(hits[0]).attributes;
            const ShaderEntry* shader = classes_[classes_.facts(state).shading_class].surface;
            auto it = std::ranges::find(subjects, shader, &Subject::shader);
            if (it == subjects.end()) {
                it = subjects.insert(subjects.end(), {shader, {}});
                seen.push_back(0);
            }
            std::uint32_t& num_seen = seen[static_cast<std::size_t>(it - subjects.begin())];
            const float z =
                static_cast<float>(ray.origin.z) + hits[0].t * static_cast<float>(ray.direction.z);
            const Place place{hits[0], camera_.footprint(z, 1)};
            const std::uint32_t at = PixelHash::mix(num_seen) % (num_seen + 1); // reservoir
            ++num_seen;
            if (it->places.size() < max_places) {
                it->places.push_back(place);
            } else if (at < max_places) {
                it->places[at] = place;
            }
        }
    }
    return subjects;
}

EnergyRow EnergyCheck::check(const Subject& subject) {
    EnergyRow row;
    row.shader = subject.shader;
    row.num_places = subject.places.size();
    EnergyProbe probe(frame_, thread_);
    for (std::size_t p = 0; p < subject.places.size(); ++p) {
        const EnergyProbe::Place place{*subject.shader, subject.places[p].hit,
                                       subject.places[p].footprint};
        const PlaceCheck at(probe, place, PixelHash::mix(static_cast<std::uint32_t>(p) + 1));
        for (std::size_t i = 0; i < std::size(angles_deg); ++i) {
            keep_worst(row.by_light, i, at.by_light(angles_deg[i]));
            keep_worst(row.by_surroundings, i, at.by_surroundings(angles_deg[i]));
        }
    }
    return row;
}

std::vector<EnergyRow> EnergyCheck::run() {
    std::vector<EnergyRow> rows;
    for (const Subject& subject : find_places()) {
        rows.push_back(check(subject));
    }
    return rows;
}

} // namespace trace
