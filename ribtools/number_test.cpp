// SPDX-License-Identifier: Apache-2.0
// The fast number reader against the C library, which rounds correctly.
#include "ribtools/number.h"

#include <cfloat>
#include <cmath>
#include <cstdlib>
#include <gtest/gtest.h>
#include <random>
#include <string>

namespace {

float read_float(const std::string& text) {
    const rib::Decimal d = rib::scan_decimal(text.c_str());
    EXPECT_EQ(d.end, text.c_str() + text.size()) << text;
    return rib::to_float(d);
}

TEST(Number, GrammarOfTheSpecification) {
    for (const char* good :
         {"1", "-1", "+2", "1.", ".5", "-.5", "1e3", "1.e-4", "0.25E+2", "007"}) {
        EXPECT_EQ(rib::scan_decimal(good).end, good + std::string(good).size()) << good;
    }
    for (const char* bad : {"", "-", ".", "+.", "e5", "x", "-e1"}) {
        EXPECT_EQ(rib::scan_decimal(bad).end, nullptr) << bad;
    }
    const char* exponent = "1e";
    EXPECT_EQ(rib::scan_decimal(exponent).end, nullptr);
}

TEST(Number, IntegersAreTold) {
    EXPECT_TRUE(rib::scan_decimal("12").is_integer);
    EXPECT_FALSE(rib::scan_decimal("12.").is_integer);
    EXPECT_FALSE(rib::scan_decimal("1e2").is_integer);
}

TEST(Number, FloatsRoundAsStrtof) {
    for (const char* text :
         {"0", "-0.0", "0.1", "0.33333334", "3.4028234e38", "1.1754944e-38", "1e-40", "1.4e-45",
          "16777217", "16777219", "9007199254740993", "0.000000059604644775390625",
          // Between two floats, told apart only by a late digit.
          "1.00000005960464477539062500000001", "1.000000059604644775390625",
          "123456789012345678901234567890",
          "0.00000000000000000000000000000000000000000000000000001e53"}) {
        EXPECT_EQ(read_float(text), std::strtof(text, nullptr)) << text;
    }
}

TEST(Number, RandomFloatsRoundAsStrtof) {
    std::mt19937 random(7);
    for (int i = 0; i < 20000; ++i) {
        char text[64];
        const double value =
            std::ldexp(static_cast<double>(random()), static_cast<int>(random() % 200) - 130);
        std::snprintf(text, sizeof text, "%.*g", static_cast<int>(random() % 20) + 1, value);
        ASSERT_EQ(read_float(text), std::strtof(text, nullptr)) << text;
        const rib::Decimal d = rib::scan_decimal(text);
        ASSERT_EQ(rib::to_double(d), std::strtod(text, nullptr)) << text;
    }
}

TEST(Number, PlainNumbersAgreeWithTheGeneralReader) {
    std::mt19937 random(11);
    for (int i = 0; i < 20000; ++i) {
        char text[64 + rib::number_padding] = {};
        std::snprintf(text, 64, "%.*f", static_cast<int>(random() % 12),
                      (static_cast<double>(random()) - 2e9) /
                          std::pow(10, static_cast<int>(random() % 12)));
        const rib::PlainNumber n = rib::scan_plain(text);
        if (n.end) {
            ASSERT_EQ(n.end, text + std::string(text).size()) << text;
            ASSERT_EQ(n.value, std::strtod(text, nullptr)) << text;
            if (rib::rounds_once(n.value)) {
                ASSERT_EQ(static_cast<float>(n.value), std::strtof(text, nullptr)) << text;
            }
        }
    }
    for (const char* not_plain :
         {"+1", "1e5", "x", ".", "-", "1234567890123456", "0.1234567890123456"}) {
        const std::string padded = not_plain + std::string(rib::number_padding, '\0');
        EXPECT_EQ(rib::scan_plain(padded.c_str()).end, nullptr) << not_plain;
    }
}

TEST(Number, OutOfRangeStaysFinite) {
    EXPECT_EQ(read_float("1e39"), FLT_MAX);
    EXPECT_EQ(read_float("-1e999999999"), -FLT_MAX);
    EXPECT_EQ(read_float("1e-999999999"), 0.0f);
    EXPECT_EQ(read_float("0e99999"), 0.0f);
    EXPECT_EQ(rib::to_double(rib::scan_decimal("1e400")), DBL_MAX);
    EXPECT_EQ(rib::narrow(1e300), FLT_MAX);
    EXPECT_EQ(read_float(std::string(400, '9')), FLT_MAX);
    EXPECT_EQ(read_float("0." + std::string(400, '0') + "1"), 0.0f);
}

} // namespace
