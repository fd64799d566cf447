// SPDX-License-Identifier: Apache-2.0
// Against the C library's basic expressions, which are the definition; hostile patterns must end.
#include "runtime/base/pattern.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <random>
#include <regex.h>

namespace {

bool by_library(const std::string& pattern, const std::string& subject, bool& valid) {
    regex_t regex;
    valid = regcomp(&regex, pattern.c_str(), REG_NOSUB) == 0;
    if (!valid) {
        return false;
    }
    const bool found = regexec(&regex, subject.c_str(), 0, nullptr, 0) == 0;
    regfree(&regex);
    return found;
}

TEST(Pattern, AgreesWithTheLibrary) {
    for (const char* pattern : {"",           "a",
                                "^a.c$",      "a*b",
                                "*a",         "^*a",
                                "\\(*a\\)",   "a+b",
                                "a\\+b",      "a\\?b",
                                "(a)",        "\\(ab\\)*c",
                                "a\\{2\\}",   "a\\{2,\\}b",
                                "a\\{1,2\\}", "a|b",
                                "a\\|b",      "[abc]",
                                "[^abc]",     "[]a]",
                                "[^]a]",      "[a-c]x",
                                "[a\\]",      "[[:digit:]]*$",
                                "[[.a.]]",    "a^b",
                                "a$b",        "$",
                                "^$",         "\\.",
                                "\\$",        "\\^",
                                "\\*",        "wood.*[0-9]$",
                                "{",          "a{2}",
                                "\\(^a\\)",   "\\(a$\\)",
                                "x\\|^a",     "[b-]"}) {
        const base::Pattern mine(pattern);
        EXPECT_EQ(mine.error(), "") << pattern;
        for (const char* subject :
             {"",    "a",     "b",           "ab",   "abc", "aab", "aaab", "*a", "a+b", "a|b",
              "(a)", "ababc", "a^b",         "a$b",  "]",   "\\",  "cx",   "-",  "^",   "$",
              ".",   "*",     "wood_floor7", "a{2}", "{",   "xyz", "a\nb", "12"}) {
            bool valid = false;
            EXPECT_EQ(mine.matches(subject), by_library(pattern, subject, valid))
                << pattern << " in " << subject;
            EXPECT_TRUE(valid) << pattern;
        }
    }
}

TEST(Pattern, RandomPatternsAgree) {
    static constexpr const char* parts[] = {"a",   "b", ".", "*", "[ab]", "[^a]",       "\\(",
                                            "\\)", "^", "$", "+", "\\|",  "a\\{1,2\\}", "?"};
    std::mt19937 random(7);
    int num_valid = 0;
    for (int round = 0; round < 3000; ++round) {
        std::string pattern, subject;
        for (unsigned n = random() % 7; n > 0; --n) {
            pattern += parts[random() % std::size(parts)];
        }
        for (unsigned n = random() % 6; n > 0; --n) {
            subject += "ab+?^$"[random() % 6];
        }
        // Where POSIX leaves the meaning open: a repeat after nothing, a bar or another repeat, an
        // anchor in the middle.
        static constexpr const char* open[] = {"^*",    "|*",   "(*",   "**",   "}*",    "*a\\{",
                                               "}a\\{", "|\\)", "(\\|", "|\\|", "\\(\\)"};
        const bool is_open = std::any_of(std::begin(open), std::end(open), [&](const char* part) {
            return pattern.find(part) != std::string::npos;
        });
        const std::size_t end = pattern.find('$');
        if (is_open || (end != std::string::npos && end + 1 < pattern.size()) ||
            pattern.find("^", 1) != std::string::npos || pattern.starts_with("\\|") ||
            pattern.ends_with("|")) {
            continue;
        }
        const base::Pattern mine(pattern);
        bool valid = false;
        const bool expected = by_library(pattern, subject, valid);
        if (valid && mine.error().empty()) {
            ++num_valid;
            EXPECT_EQ(mine.matches(subject), expected) << pattern << " in " << subject;
        }
    }
    EXPECT_GT(num_valid, 200);
}

TEST(Pattern, MistakesAreNamed) {
    EXPECT_NE(base::Pattern("[").error(), "");
    EXPECT_NE(base::Pattern("\\(a").error(), "");
    EXPECT_NE(base::Pattern("\\(a\\)\\1").error(), "");
    EXPECT_NE(base::Pattern("a\\{2").error(), "");
    EXPECT_NE(base::Pattern("a\\").error(), "");
    EXPECT_FALSE(base::Pattern("[").matches("["));
}

TEST(Pattern, HostilePatternsEnd) {
    std::string nested = "a";
    for (int i = 0; i < 200; ++i) {
        nested = "\\(" + nested + "\\)*";
    }
    const std::string subject(100000, 'a');
    EXPECT_FALSE(base::Pattern(nested + "b").matches(subject));
    EXPECT_FALSE(base::Pattern("\\(a*\\)*\\(a*\\)*\\(a*\\)*b$").matches(subject));
    (void)base::Pattern("\\(\\(\\(a\\{255\\}\\)\\{255\\}\\)\\{255\\}\\)\\{255\\}").matches(subject);
    EXPECT_FALSE(base::Pattern(std::string(100000, '[')).matches(subject));
}

} // namespace
