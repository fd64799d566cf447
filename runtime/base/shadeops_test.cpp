// SPDX-License-Identifier: Apache-2.0
#include "runtime/base/shadeops.h"

#include <gtest/gtest.h>

#ifndef TEST_SHADEOPS
#error "TEST_SHADEOPS names the directory of the DSO"
#endif

namespace {

TEST(Shadeops, OverloadsByName) {
    base::ShadeopLibrary library({TEST_SHADEOPS});
    const auto sums = library.find("dsosum");
    ASSERT_EQ(sums.size(), 2U);
    EXPECT_EQ(sums[0]->signature(), "f(f,f)");
    EXPECT_EQ(sums[1]->signature(), "c(c,c)");
    EXPECT_EQ(library.find("dsosum", "c(c,c)"), sums[1]);
    EXPECT_EQ(library.find("dsosum", "c(c,f)"), nullptr);
    EXPECT_TRUE(library.find("nothing").empty());
    const auto scales = library.find("dsoscale"); // the older form
    ASSERT_EQ(scales.size(), 2U);
    EXPECT_EQ(scales[1]->signature(), "c(c,f)");
    const auto problems = library.take_problems();
    ASSERT_EQ(problems.size(), 1U);
    EXPECT_NE(problems[0].find("x dsobroken(f)"), std::string::npos);
    EXPECT_NE(library.identity(), "");
}

TEST(Shadeops, Calls) {
    base::ShadeopLibrary library({TEST_SHADEOPS});
    float a = 2, b = 3, result = 0;
    void* const floats[] = {&result, &a, &b};
    library.find("dsosum", "f(f,f)")->call(floats);
    EXPECT_EQ(result, 5);
    library.find("dsoscale", "f(f,f)")->call(floats);
    EXPECT_EQ(result, 6);
    float p[3] = {1, 2, 3}, turned[3] = {}, squared = 0;
    void* const points[] = {turned, p, &squared};
    library.find("dsoturn", "p(p,F)")->call(points);
    EXPECT_EQ(turned[0], -2);
    EXPECT_EQ(turned[1], 1);
    EXPECT_EQ(squared, 14);
    const char* name = "x";
    const char* text = nullptr;
    void* const texts[] = {&name, &a, &text};
    library.find("dsolabel", "void(s,f,S)")->call(texts);
    EXPECT_STREQ(text, "x2");
}

TEST(Shadeops, OnlyNamedDirectories) {
    base::ShadeopLibrary none({});
    EXPECT_TRUE(none.find("dsosum").empty());
    EXPECT_TRUE(none.take_problems().empty());
    base::ShadeopLibrary missing({"/nonexistent/directory"});
    EXPECT_TRUE(missing.find("dsosum").empty());
    EXPECT_EQ(missing.take_problems().size(), 1U);
}

} // namespace
