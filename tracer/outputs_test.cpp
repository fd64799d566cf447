// SPDX-License-Identifier: Apache-2.0
// What displays ask for: modes, names, types, rules of blending, sharing, order of the film's
// channels.
#include "tracer/outputs.h"

#include <cstdio>
#include <gtest/gtest.h>

namespace {

using trace::Blend;
using trace::ChannelRole;

class OutputsTest : public testing::Test {
protected:
    ~OutputsTest() override { std::fclose(null_); }

    trace::OutputSet plan(const std::vector<std::string>& modes) {
        std::vector<rib::Display> displays;
        for (const std::string& mode : modes) {
            displays.push_back({"a.exr", "openexr", mode, {}, {}});
        }
        return {displays, options_, shader_outputs_, diag_};
    }
    static std::string names(const trace::DisplayPlan& plan) {
        std::string all;
        for (const trace::ShownChannel& c : plan.channels) {
            all += (all.empty() ? "" : " ") + c.name;
        }
        return all;
    }
    std::string names_of(const std::string& mode) { return names(plan({mode}).displays().front()); }
    static rib::ParamDecl decl(rib::ParamType type, int length = 1) {
        return {rib::StorageClass::Varying, type, length, length > 1};
    }
    void add_channel(const std::string& name, rib::ParamType type, const char* source,
                     const char* filter) {
        rib::Param head;
        head.name = name;
        head.decl = decl(type);
        rib::ParamList list{{head}};
        for (const auto& [key, value] : {std::pair{"source", source}, {"filter", filter}}) {
            rib::Param p;
            p.name = key;
            p.decl.type = rib::ParamType::String;
            p.strings = {value};
            list.params.push_back(p);
        }
        options_.display_channels.push_back(list);
    }

    std::FILE* null_ = std::fopen("/dev/null", "w");
    base::Diag diag_{null_};
    rib::Options options_;
    trace::ShaderOutputs shader_outputs_{
        {"Cdiffuse", {rib::StorageClass::Varying, rib::ParamType::Color, 1, false}},
        {"list", {rib::StorageClass::Varying, rib::ParamType::Color, 2, true}},
        {"id", {rib::StorageClass::Uniform, rib::ParamType::Float, 1, false}}};
};

TEST_F(OutputsTest, Names) {
    EXPECT_EQ(names_of("rgbaz"), "R G B A Z");
    EXPECT_EQ(names_of("zrgb"), "R G B Z"); // colors first
    EXPECT_EQ(names_of("varying color Ci,a"), "R G B A");
    EXPECT_EQ(names_of(" Ci , Oi "), "R G B Oi.R Oi.G Oi.B");
    EXPECT_EQ(names_of("Cdiffuse,id"), "Cdiffuse.R Cdiffuse.G Cdiffuse.B id");
    EXPECT_EQ(names_of("list"), "list.0.R list.0.G list.0.B list.1.R list.1.G list.1.B");
    EXPECT_EQ(names_of("N,st,u"), "N.X N.Y N.Z st.S st.T u");
    EXPECT_EQ(names_of("hpoint P"), "P.X P.Y P.Z P.W");
    EXPECT_EQ(names_of("rgb,,a,rgb"), "R G B A"); // nothing twice
    EXPECT_EQ(names_of(""), "R G B A");
    EXPECT_EQ(diag_.count(base::Severity::Warning), 0U);
}

TEST_F(OutputsTest, WhatIsNotKnownIsLeftOut) {
    EXPECT_EQ(names_of("rgb,nowhere"), "R G B");
    EXPECT_EQ(names_of("rgbx"), "");
    EXPECT_EQ(names_of("string name"), "");
    EXPECT_EQ(names_of("varying colour x"), "");
    EXPECT_EQ(diag_.count(base::Severity::Warning), 4U);
    EXPECT_EQ(names_of("float declared"), "declared"); // black, but there
    EXPECT_EQ(diag_.count(base::Severity::Warning), 5U);
}

TEST_F(OutputsTest, OnlyWhatIsShownIsCarriedAndOnce) {
    EXPECT_EQ(plan({"rgbaz"}).num_channels(), 0U);
    const trace::OutputSet set = plan({"rgb,Cdiffuse", "Cdiffuse,id", "N"});
    EXPECT_EQ(set.outputs().size(), 3U);
    EXPECT_EQ(set.num_channels(), 7U);
    EXPECT_EQ(set.displays()[0].channels[3].extra, set.displays()[1].channels[0].extra);
}

TEST_F(OutputsTest, BlendFollowsTypeAndVariable) {
    const trace::OutputSet set = plan({"Cdiffuse,id,N,Cs,Os,s"});
    const Blend expected[] = {Blend::Over,     Blend::Over, Blend::Front,
                              Blend::Weighted, Blend::Over, Blend::Front};
    ASSERT_EQ(set.outputs().size(), std::size(expected));
    for (std::size_t i = 0; i < std::size(expected); ++i) {
        EXPECT_EQ(set.outputs()[i].blend, expected[i]) << set.outputs()[i].variable;
    }
}

TEST_F(OutputsTest, ChannelsOfOneFilterLieTogether) {
    add_channel("near", rib::ParamType::Float, "id", "zmin");
    add_channel("Ci", rib::ParamType::Color, "Ci", "box");
    const trace::OutputSet set = plan({"near,Cdiffuse", "Ci,a", "id"});
    const trace::Sampler sampler({});
    const auto weights = set.weights(sampler, diag_);
    const auto channels = set.film_channels(weights);
    ASSERT_EQ(channels.size(), 3U + 1 + 1 + 6);
    int changes = 0;
    for (std::size_t i = 1; i < channels.size(); ++i) {
        changes += channels[i] == channels[i - 1] ? 0 : 1;
    }
    EXPECT_EQ(changes, 2);
    EXPECT_EQ(set.displays()[0].picture, -1);
    EXPECT_GE(set.displays()[1].picture, 0); // color and alpha through the box
    EXPECT_EQ(set.displays()[1].channels[3].extra, -1);
}

TEST_F(OutputsTest, LoneTripleIsShownAsColor) {
    const trace::OutputSet set = plan({"id,N", "rgb,N"});
    EXPECT_EQ(set.displays()[0].channels[0].name, "N.X");
    EXPECT_EQ(set.displays()[0].channels[0].role, ChannelRole::Color);
    EXPECT_EQ(set.displays()[1].channels[3].role, ChannelRole::Other);
}

TEST_F(OutputsTest, Quantizers) {
    options_.other_quantize["id"] = {100, 0, 1000, 0};
    const auto set = plan({"id,Cdiffuse,N", "rgb"});
    const auto& shown = set.displays()[0].channels;
    ASSERT_EQ(shown.size(), 7U);
    for (const trace::ShownChannel& c : shown) {
        EXPECT_EQ(c.quantizer.one, c.name == "id" ? 100 : c.name[0] == 'C' ? 255 : 0) << c.name;
    }
}

} // namespace
