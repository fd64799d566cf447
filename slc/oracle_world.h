// SPDX-License-Identifier: Apache-2.0
// Test helper: one small world seen by emitted code (services) and by the interpreter (host), so
// that both run the same program on the same points: two lights with categories, spaces of which
// one differs per point, messages that some points get. Everything is a formula of the point's
// index.
#pragma once

#include "runtime/batch.h"
#include "runtime/uniform_prints.h"
#include "slc/interp.h"

#include <string>
#include <vector>

namespace slc {

class OracleWorld : public InterpHost {
public:
    explicit OracleWorld(rt::StringTable& strings) : strings_(strings) {}

    [[nodiscard]] static sl_services services(); // engine: the world
    // Answers a question as the service `rays` does: for packets that wait.
    void answer(sl_ray_query& query);
    // Lanes of the variant that runs: planes handed to services have that length.
    [[nodiscard]] std::uint32_t lanes() const { return lanes_; }
    void set_lanes(std::uint32_t lanes) { lanes_ = lanes; }
    [[nodiscard]] std::vector<std::string>& printed() { return printed_; }
    void begin_batch() {
        printed_.clear();
        uniform_prints_.clear();
    }

    // The value of an input variable or parameter component at a point: of moderate size, no two
    // alike.
    [[nodiscard]] static float input(std::size_t variable, int component, int point);

    // What the functions of DSOs give here: a formula of all input components.
    [[nodiscard]] static double shadeop_value(const std::string& function, double sum, int output,
                                              std::size_t component);

    // InterpHost
    int num_lights() override { return 2; }
    bool light(int index, int point, const Triple3& P, const Triple3& axis, double cos_angle,
               const std::string& category, LightSample& sample) override;
    Triple3 ambient(int point, const Triple3& P) override;
    // Smooth in origin, direction, differences and options; about a third of the rays miss.
    void rays(int point, const RayQuestion& question, RayAnswer& answer) override;
    bool space(const std::string& from, const std::string& to, int point, Matrix16& m) override;
    bool message(std::string_view function, const std::string& name, int point,
                 Value& value) override;
    void print(const std::string& text) override { printed_.push_back(text); }
    void depth_range(double& near_z, double& far_z) override;
    void shadeop(const std::string& function, int point, std::vector<Value>& values,
                 std::size_t num_outputs) override;
    int raylevel() override { return 2; }
    std::string shader_name(const std::string& type) override {
        return type.empty() ? "me" : type + "_s";
    }

    [[nodiscard]] rt::StringTable& strings() { return strings_; }

private:
    rt::StringTable& strings_;
    std::uint32_t lanes_ = SL_LANES_MAX;
    std::vector<std::string> printed_;
    rt::UniformPrints uniform_prints_; // of the batch in work
};

} // namespace slc
