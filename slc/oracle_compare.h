// SPDX-License-Identifier: Apache-2.0
// Test helper: one program run as emitted code and by the interpreter on the same points of the
// oracle's world; results and output parameters are compared.
#pragma once

#include "slc/emit_runner.h"
#include "slc/oracle_world.h"

namespace slc {

class Comparison {
public:
    Comparison(const Program& program, BuildWay way);

    [[nodiscard]] bool built() const { return object_ != nullptr; }
    // The first difference in a batch of that many points, or "".
    [[nodiscard]] std::string run(std::uint32_t num_points);
    // The emitted C.
    [[nodiscard]] const std::string& text() const { return runner_.last_c; }

private:
    void shade_in_any_order(rt::ShadeBatch& batch, const sl_services& services,
                            const sl_variant& variant);
    void fill(rt::ShadeBatch& batch, Interpreter& oracle, std::uint32_t n);
    void fill_differences(rt::ShadeBatch& batch, Interpreter& oracle, std::uint32_t n);
    [[nodiscard]] static std::string compare_lit(const rt::ShadeBatch& batch,
                                                 const Interpreter& oracle, std::uint32_t n);
    [[nodiscard]] std::string compare_variables(rt::ShadeBatch& batch, const Interpreter& oracle,
                                                std::uint32_t n);
    [[nodiscard]] std::string compare_params(rt::ShadeBatch& batch, const Interpreter& oracle,
                                             std::uint32_t n);

    EmitRunner runner_;
    Program program_; // area operators resolved
    Facts facts_;
    OracleWorld world_;
    BuildWay way_;
    const rt::ShaderObject* object_ = nullptr;
};

} // namespace slc
