// SPDX-License-Identifier: Apache-2.0
// Batches and instances against a shader object written here by hand: what slc makes, without slc.
#include "runtime/batch.h"
#include "sl_fingerprint.h"

#include <cstring>
#include <gtest/gtest.h>

namespace rt {
namespace {

// surface twice(uniform float k = 2; varying point Q = 5; output varying color out = 3; string name
// = "x") { Ci = k * Cs; out = Q (by components) + 1; suspends once when the frame says so }
struct Block {
    float k;
    alignas(16) float* Q;
    alignas(16) float Q_default[3];
    alignas(16) float* out;
    alignas(16) float out_default[3];
    alignas(16) sl_string name;
};

sl_status shade(const sl_batch* batch, std::uint32_t first, std::uint32_t count, sl_frame*) {
    auto* block = static_cast<Block*>(batch->params);
    for (std::uint32_t i = first; i < first + count; ++i) {
        for (std::uint32_t c = 0; c < 3; ++c) {
            const std::uint32_t at = c * batch->stride + i;
            batch->main->var[SL_VAR_Ci][at] = block->k * batch->main->var[SL_VAR_Cs][at];
            block->out[at] = block->Q[at] + 1;
        }
    }
    batch->lit[first / 4] = 1;
    return SL_DONE;
}

sl_status suspend_once(const sl_batch* batch, std::uint32_t first, std::uint32_t count,
                       sl_frame* frame) {
    if (frame->state == 0) {
        frame->state = 1;
        frame->rays.sample = static_cast<int>(first);
        return SL_SUSPENDED;
    }
    return shade(batch, first, count, frame);
}

void init(const sl_init* in) {
    auto* block = static_cast<Block*>(in->params);
    if (!in->bound[0]) {
        block->k = 2;
    }
    if (!in->bound[1]) {
        std::fill_n(block->Q_default, 3, 5.0F);
    }
    if (!in->bound[2]) {
        std::fill_n(block->out_default, 3, 3.0F);
    }
    if (!in->bound[3]) {
        block->name = in->strings[0];
    }
}

const char* const strings[] = {"x"};
const sl_param params[] = {
    {"k", SL_TYPE_float, SL_DETAIL_uniform, 0, 0, offsetof(Block, k), 0},
    {"Q", SL_TYPE_point, SL_DETAIL_varying, 0, 0, offsetof(Block, Q), 0},
    {"out", SL_TYPE_color, SL_DETAIL_varying, 0, 1, offsetof(Block, out), 0},
    {"name", SL_TYPE_string, SL_DETAIL_uniform, 0, 0, offsetof(Block, name), 0},
};

struct TestObject {
    sl_variant variant{SL_ISA_any, 4, 0, 0, shade, init};
    const sl_variant* variants[1] = {&variant};
    sl_object object{};

    TestObject() {
        object.fingerprint = SL_ABI_FINGERPRINT;
        object.name = "twice";
        object.num_params = 4;
        object.params = params;
        object.params_size = sizeof(Block);
        object.needed = 1ULL << SL_VAR_Cs | 1ULL << SL_VAR_E;
        object.written = 1ULL << SL_VAR_Ci;
        object.num_strings = 1;
        object.strings = strings;
        object.num_variants = 1;
        object.variants = variants;
    }
};

class Batches : public ::testing::Test {
protected:
    StringTable table;
    base::Diag diag{std::tmpfile()};
    ShaderLibrary library{{}, table, diag};
    sl_services services{};

    BoundValue value(const char* name, sl_type type, std::vector<float> floats, int length = 0) {
        return {name, type, length, std::move(floats), {}, {}};
    }
};

TEST_F(Batches, DefaultsAndBoundValues) {
    const TestObject source;
    const ShaderObject* object = library.adopt(source.object);
    ASSERT_NE(object, nullptr);
    BoundValue name{"name", SL_TYPE_string, 0, {}, {"hello"}, {}};
    const std::vector<BoundValue> values = {value("Q", SL_TYPE_vector, {7, 8, 9}), name};
    const ShaderInstance instance(*object, values, services, nullptr, table, diag);
    EXPECT_EQ(instance.uniform_floats(0)[0], 2);
    EXPECT_EQ(instance.uniform_floats(1)[2], 9);
    EXPECT_EQ(instance.uniform_floats(2)[1], 3);
    EXPECT_EQ(instance.uniform_string(3), table.intern("hello"));
    EXPECT_FALSE(diag.had_errors());
}

TEST_F(Batches, MismatchesAreReportedAndLeftOut) {
    const TestObject source;
    const ShaderObject* object = library.adopt(source.object);
    const std::vector<BoundValue> values = {
        value("k", SL_TYPE_color, {1, 2, 3}), // wrong type
        value("Q", SL_TYPE_color, {1, 2, 3}), // a colour is no point
        value("k", SL_TYPE_float, {1, 2}, 2), // wrong length
        value("k", SL_TYPE_float, {}),        // no value
        value("missing", SL_TYPE_float, {1}), {"name", SL_TYPE_string, 0, {}, {}, {}},
    };
    const ShaderInstance instance(*object, values, services, nullptr, table, diag);
    EXPECT_EQ(diag.count(base::Severity::Error), 5U);
    EXPECT_EQ(diag.count(base::Severity::Warning), 1U);
    EXPECT_EQ(instance.uniform_floats(0)[0], 2);
    EXPECT_EQ(instance.uniform_floats(1)[0], 5);
}

TEST_F(Batches, EverySizeShadesItsPointsAndOnlyThose) {
    const TestObject source;
    const ShaderObject* object = library.adopt(source.object);
    const ShaderInstance instance(*object, {}, services, nullptr, table, diag);
    ShadeBatch batch;
    for (const std::uint32_t n : {1U, 7U, 256U, 64U, 3U}) {
        batch.begin(instance, n);
        EXPECT_TRUE(batch.has(SL_VAR_Cs));
        EXPECT_TRUE(batch.has(SL_VAR_Ci));
        EXPECT_FALSE(batch.has(SL_VAR_P));
        EXPECT_EQ(batch.stride() % 8, 0U);
        for (int c = 0; c < 3; ++c) {
            EXPECT_EQ(reinterpret_cast<std::uintptr_t>(batch.plane(SL_VAR_Cs, 0)) % 64, 0U);
            for (std::uint32_t i = 0; i < n; ++i) {
                batch.plane(SL_VAR_Cs, c)[i] = static_cast<float>(i) + static_cast<float>(c);
            }
        }
        batch.param_plane(1, 1)[0] = 40;
        *batch.param_uniform(0) = 10;
        EXPECT_EQ(batch.run({&services, nullptr}), 0U);
        EXPECT_TRUE(batch.lit(0));
        for (std::uint32_t i = 0; i < batch.stride(); ++i) {
            EXPECT_EQ(batch.plane(SL_VAR_Ci, 2)[i], i < n ? 10 * (static_cast<float>(i) + 2) : 0);
        }
        EXPECT_EQ(batch.param_plane(2, 0)[n - 1], 6);
        EXPECT_EQ(batch.param_plane(2, 1)[0], 41);
        EXPECT_EQ(batch.param_plane(0, 0), nullptr) << "k is uniform";
        EXPECT_EQ(batch.param_strings(3), nullptr);
        EXPECT_STREQ(*batch.param_uniform_string(3), "x");
    }
}

TEST_F(Batches, RestartRunsTheSamePointsAgain) {
    const TestObject source;
    const ShaderObject* object = library.adopt(source.object);
    const ShaderInstance instance(*object, {}, services, nullptr, table, diag);
    ShadeBatch batch;
    batch.begin(instance, 5);
    batch.param_plane(1, 0)[0] = 7;
    batch.plane(SL_VAR_Cs)[4] = 2;
    EXPECT_EQ(batch.points().var[SL_VAR_Cs], batch.plane(SL_VAR_Cs));
    EXPECT_EQ(batch.aux_points_u(), nullptr) << "no area operators";
    EXPECT_EQ(batch.run({&services, nullptr}), 0U);
    EXPECT_EQ(batch.param_plane(2, 0)[0], 8);
    batch.restart();
    EXPECT_FALSE(batch.lit(0));
    EXPECT_EQ(batch.param_plane(2, 0)[0], 3) << "outputs start from their bound value";
    EXPECT_EQ(batch.param_plane(1, 0)[0], 7) << "inputs stay";
    EXPECT_EQ(batch.run({&services, nullptr}), 0U);
    EXPECT_EQ(batch.param_plane(2, 0)[0], 8);
    EXPECT_EQ(batch.plane(SL_VAR_Ci)[4], 4);
}

TEST_F(Batches, DifferencesHavePlanesWhereTheShaderAsks) {
    TestObject source;
    sl_param asked[4];
    std::copy_n(params, 4, asked);
    asked[1].needs_aux = 1;
    source.object.params = asked;
    source.object.needed_aux = 1ull << SL_VAR_s;
    source.object.written_aux = 1ull << SL_VAR_P;
    const ShaderObject* object = library.adopt(source.object);
    const ShaderInstance instance(*object, {}, services, nullptr, table, diag);
    ShadeBatch batch;
    batch.begin(instance, 9);
    ASSERT_NE(batch.aux_points_u(), nullptr);
    EXPECT_NE(batch.aux_u(SL_VAR_s), nullptr);
    EXPECT_NE(batch.aux_v(SL_VAR_P, 2), nullptr);
    EXPECT_EQ(batch.aux_u(SL_VAR_N), nullptr);
    // Behind the three planes of Q lie its differences, zero until somebody fills them.
    EXPECT_EQ(batch.param_aux(1, 1, 0), batch.param_plane(1, 3));
    EXPECT_EQ(batch.param_aux(1, 2, 2), batch.param_plane(1, 8));
    EXPECT_EQ(batch.param_aux(1, 2, 2)[8], 0);
    EXPECT_EQ(batch.param_aux(2, 1, 0), nullptr);
}

TEST_F(Batches, SuspendedPacketsAreCalledAgain) {
    TestObject source;
    source.variant.shade = suspend_once;
    source.variant.frame_size = sizeof(sl_frame);
    source.variant.frame_align = 32;
    const ShaderObject* object = library.adopt(source.object);
    const ShaderInstance instance(*object, {}, services, nullptr, table, diag);
    ShadeBatch batch;
    batch.begin(instance, 10);
    EXPECT_EQ(batch.run({&services, nullptr}), 3U);
    ASSERT_NE(batch.request(2), nullptr);
    EXPECT_EQ(batch.request(2)->sample, 8);
    EXPECT_EQ(batch.run({&services, nullptr}), 0U);
    EXPECT_EQ(batch.request(2), nullptr);
}

TEST_F(Batches, ObjectsOfAnotherAbiAreRefused) {
    TestObject source;
    source.object.fingerprint = "0000";
    EXPECT_EQ(library.adopt(source.object), nullptr);
    source.object.fingerprint = SL_ABI_FINGERPRINT;
    source.variant.isa = 77; // an instruction set this loader does not know
    EXPECT_EQ(library.adopt(source.object), nullptr);
    EXPECT_TRUE(diag.had_errors());
}

TEST(StringTableTest, EqualTextsShareAPointer) {
    StringTable table;
    const sl_string a = table.intern("abc");
    EXPECT_EQ(a, table.intern(std::string("ab") + "c"));
    EXPECT_NE(a, table.intern("abd"));
    EXPECT_EQ(table.intern(std::string_view("abc\0def", 7)), a);
}

} // namespace
} // namespace rt
