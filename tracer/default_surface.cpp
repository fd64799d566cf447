// SPDX-License-Identifier: Apache-2.0
#include "tracer/default_surface.h"

#include "sl_fingerprint.h"

#include <cmath>

namespace trace {

namespace {

// The values of shaders/defaultsurface.sl.
constexpr float Ka = 0.2f;
constexpr float Kd = 0.8f;

// Ci = Os Cs (Ka + Kd |N.I| / |N||I|), Oi = Os
sl_status shade(const sl_batch* batch, uint32_t first, uint32_t count, sl_frame*) {
    const uint32_t stride = batch->stride;
    float* const* var = batch->main->var;
    for (uint32_t i = first; i < first + count; ++i) {
        float NN = 0, II = 0, NI = 0;
        for (uint32_t k = 0; k < 3; ++k) {
            const float N = var[SL_VAR_N][k * stride + i], I = var[SL_VAR_I][k * stride + i];
            NN += N * N, II += I * I, NI += N * I;
        }
        const float lengths = std::sqrt(NN) * std::sqrt(II);
        const float facing = lengths > 0 ? std::fabs(NI) / lengths : 1;
        for (uint32_t k = 0; k < 3; ++k) {
            const uint32_t at = k * stride + i;
            var[SL_VAR_Ci][at] = var[SL_VAR_Os][at] * var[SL_VAR_Cs][at] * (Ka + Kd * facing);
            var[SL_VAR_Oi][at] = var[SL_VAR_Os][at];
        }
    }
    return SL_DONE;
}

void init(const sl_init*) {}

constexpr sl_variant variant = {SL_ISA_any, 8, 0, 0, shade, init};
constexpr const sl_variant* variants[] = {&variant};

constexpr uint64_t bit(sl_variable id) {
    return 1ULL << id;
}

} // namespace

const sl_object& default_surface_object() {
    static constexpr sl_object object = {
        .fingerprint = SL_ABI_FINGERPRINT,
        .name = "builtin_defaultsurface",
        .type = SL_SHADER_surface,
        .num_params = 0,
        .params = nullptr,
        .params_size = 0,
        .facts = SL_FACT_writes_opacity,
        .needed = bit(SL_VAR_N) | bit(SL_VAR_I) | bit(SL_VAR_Cs) | bit(SL_VAR_Os),
        .written = bit(SL_VAR_Ci) | bit(SL_VAR_Oi),
        .needed_aux = 0,
        .written_aux = 0,
        .num_strings = 0,
        .strings = nullptr,
        .num_variants = 1,
        .variants = variants,
        .ir = "",
        .source = "default_surface.cpp",
        .num_places = 0,
        .places = nullptr,
    };
    return object;
}

} // namespace trace
