// SPDX-License-Identifier: Apache-2.0
// Test helper: shaders with area operators, and what their variables are at a shading point and at
// its auxiliary points. Shared by the tests on the interpreter and on emitted code.
#pragma once

#include "slc/aux_analysis.h"
#include "slc/builtins.h"
#include "slc/oracle_world.h"

#include <span>
#include <string>

namespace slc {

struct AreaCase {
    const char* name;
    const char* body; // statements; results go to r and q
    const char* functions = "";
    [[nodiscard]] std::string text() const; // of the whole shader
};

[[nodiscard]] std::span<const AreaCase> area_cases();

// Value of a predefined variable at a point of a batch (aux 0) and its neighbours (1, 2). The
// places are spread so that neighbours often take different ways.
[[nodiscard]] Value area_input(int variable, int point, int aux);
// Of a varying float parameter.
[[nodiscard]] double area_param(const Program& program, const Param& p, int point, int aux);
// Gives an interpreter with one point all of it.
void set_area_inputs(const Program& program, Interpreter& interpreter, int point, int aux);

// The oracle's world as one point of a batch sees it.
class OnePoint : public InterpHost {
public:
    OnePoint(OracleWorld& world, int point) : world_(world), point_(point) {}
    int num_lights() override { return world_.num_lights(); }
    bool light(int index, int, const Triple3& P, const Triple3& axis, double cos_angle,
               const std::string& category, LightSample& sample) override {
        return world_.light(index, point_, P, axis, cos_angle, category, sample);
    }
    Triple3 ambient(int, const Triple3& P) override { return world_.ambient(point_, P); }
    bool space(const std::string& from, const std::string& to, int, Matrix16& m) override {
        return world_.space(from, to, point_, m);
    }
    bool message(std::string_view function, const std::string& name, int, Value& value) override {
        return world_.message(function, name, point_, value);
    }
    std::uint32_t seed(int) override { return world_.seed(point_); }

private:
    OracleWorld& world_;
    int point_;
};

} // namespace slc
