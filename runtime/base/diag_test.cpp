// SPDX-License-Identifier: Apache-2.0
// Messages: how they read, what is printed once, and what is gathered for reports.
#include "runtime/base/diag.h"

#include <gtest/gtest.h>

namespace base {
namespace {

class DiagTest : public ::testing::Test {
protected:
    Diag diag{std::tmpfile()};
};

TEST_F(DiagTest, LinesNameTheirPlace) {
    const SourcePos pos{diag.file_id("a.rib"), 3, 7};
    diag.report(Severity::Warning, Code::Range, pos, "too large");
    diag.report(Severity::Error, Code::None, {}, "no place");
    EXPECT_EQ(diag.messages(), (std::vector<std::string>{"a.rib:3:7: warning: too large",
                                                         "perigee: error: no place"}));
}

TEST_F(DiagTest, EqualMessagesAreGatheredWithTheirPlaces) {
    const std::uint32_t file = diag.file_id("a.rib");
    for (std::uint32_t line = 1; line <= 20; ++line) {
        diag.report(Severity::Warning, Code::Range, {file, line, 0}, "too large");
    }
    diag.report(Severity::Error, Code::Range, {file, 1, 0}, "too large");
    const auto records = diag.records();
    ASSERT_EQ(records.size(), 2U);
    EXPECT_EQ(records[0].count, 20U);
    EXPECT_EQ(records[0].places.front(), "a.rib:1");
    EXPECT_LT(records[0].places.size(), 20U);
    EXPECT_EQ(records[1].severity, Severity::Error);
}

TEST_F(DiagTest, MessagesPrintedOnceAreCountedEachTime) {
    for (int i = 0; i < 5; ++i) {
        diag.report_once("key", Severity::Warning, Code::BadToken, {}, "unknown option");
    }
    EXPECT_EQ(diag.messages().size(), 1U);
    EXPECT_EQ(diag.count(Severity::Warning), 1U);
    EXPECT_EQ(diag.records().at(0).count, 5U);
}

TEST_F(DiagTest, SilencedMessagesAreStillGathered) {
    diag.set_threshold(Severity::Error);
    diag.report(Severity::Warning, Code::Range, {}, "quiet");
    EXPECT_TRUE(diag.messages().empty());
    EXPECT_EQ(diag.records().size(), 1U);
    EXPECT_EQ(code_name(diag.records()[0].code), "RIE_RANGE");
}

} // namespace
} // namespace base
