// SPDX-License-Identifier: Apache-2.0
#include "ribtools/rib_lex.h"

#include <gtest/gtest.h>

namespace {

using rib::Lexer;
using rib::Token;
using rib::TokenKind;

// Hands out a few bytes at a time, so that every token meets a block boundary.
class Trickle final : public rib::ByteSource {
public:
    Trickle(std::string text, std::size_t step) : text_(std::move(text)), step_(step) {}
    std::size_t read(char* buffer, std::size_t size) override {
        const std::size_t n = std::min({size, step_, text_.size() - at_});
        text_.copy(buffer, n, at_);
        at_ += n;
        return n;
    }
    const std::string& error() const override { return error_; }

private:
    std::string text_, error_;
    std::size_t step_, at_ = 0;
};

std::vector<Token> tokens(const std::string& text, std::size_t step = 1000000) {
    Lexer lexer(std::make_unique<Trickle>(text, step), {1, 1, 1}, nullptr);
    std::vector<Token> all;
    for (;;) {
        lexer.advance();
        if (lexer.token().kind == TokenKind::End) {
            return all;
        }
        all.push_back(lexer.token());
    }
}

TEST(Lexer, KindsAndPlaces) {
    const auto t = tokens("Sphere 1 -.5\r\n  \"a b\" [ 2#x\n]\rEnd");
    ASSERT_EQ(t.size(), 8u);
    EXPECT_EQ(t[0].text, "Sphere");
    EXPECT_EQ(t[1].number, 1);
    EXPECT_TRUE(t[1].is_integer);
    EXPECT_EQ(t[2].number, -.5);
    EXPECT_FALSE(t[2].is_integer);
    EXPECT_EQ(t[3].text, "a b");
    EXPECT_EQ(t[3].pos, (base::SourcePos{1, 2, 3}));
    EXPECT_EQ(t[4].kind, TokenKind::ArrayBegin);
    EXPECT_EQ(t[5].pos, (base::SourcePos{1, 2, 11}));
    EXPECT_EQ(t[6].pos, (base::SourcePos{1, 3, 1}));
    EXPECT_EQ(t[7].pos, (base::SourcePos{1, 4, 1}));
}

TEST(Lexer, Escapes) {
    const auto t = tokens(R"("\n\r\t\b\f\\\"" "\101\7x\1012" "a\
b" "\q\ ")");
    ASSERT_EQ(t.size(), 4u);
    EXPECT_EQ(t[0].text, "\n\r\t\b\f\\\"");
    EXPECT_EQ(t[1].text, "A\7xA2");
    EXPECT_EQ(t[2].text, "ab");
    EXPECT_EQ(t[3].text, "q ");
}

TEST(Lexer, StringsMayHoldLineEnds) {
    const auto t = tokens("\"a\r\nb\" x");
    ASSERT_EQ(t.size(), 2u);
    EXPECT_EQ(t[0].text, "a\r\nb");
    EXPECT_EQ(t[1].pos.line, 2u);
}

TEST(Lexer, MalformedNumbersAreBad) {
    for (const char* text : {"01a3", "1e", "-", "+", "1.2.3", "--1", "1e+", "."}) {
        const auto t = tokens(text);
        ASSERT_EQ(t.size(), 1u) << text;
        EXPECT_EQ(t[0].kind, TokenKind::Bad) << text;
        EXPECT_EQ(t[0].text, text);
    }
}

TEST(Lexer, UnclosedStringIsBadAtItsBeginning) {
    const auto t = tokens("A \"never\nending");
    ASSERT_EQ(t.size(), 2u);
    EXPECT_EQ(t[1].kind, TokenKind::Bad);
    EXPECT_EQ(t[1].pos, (base::SourcePos{1, 1, 3}));
}

TEST(Lexer, ByteOfAllOnesEndsTheStream) {
    EXPECT_EQ(tokens("A 1 \xff B").size(), 2u);
}

TEST(Lexer, TokensDoNotDependOnBlocks) {
    const std::string text =
        "Name 12345.678e-2 \"str\\123ing\\\r\n\" [1 2 3]# comment\r\n[\"a\" \"b\"] Last";
    const auto whole = tokens(text);
    for (std::size_t step = 1; step < 12; ++step) {
        const auto pieces = tokens(text, step);
        ASSERT_EQ(pieces.size(), whole.size()) << step;
        for (std::size_t i = 0; i < whole.size(); ++i) {
            EXPECT_EQ(pieces[i].text, whole[i].text) << step;
            EXPECT_EQ(pieces[i].pos, whole[i].pos) << step;
            EXPECT_EQ(pieces[i].number, whole[i].number) << step;
        }
    }
}

TEST(Lexer, ArraysDoNotDependOnBlocks) {
    std::string text = "[";
    std::vector<float> expected;
    for (int i = 0; i < 60000; ++i) { // several blocks
        text += std::to_string(i) + ".25" + (i % 7 == 0 ? "\r\n" : " ");
        expected.push_back(static_cast<float>(i) + .25f);
    }
    text += "] End";
    for (const std::size_t step : {std::size_t{1000003}, std::size_t{4099}, std::size_t{7}}) {
        Lexer lexer(std::make_unique<Trickle>(text, step), {1, 1, 1}, nullptr);
        lexer.advance();
        std::vector<float> values;
        ASSERT_TRUE(lexer.read_floats(values));
        EXPECT_EQ(values, expected);
        EXPECT_EQ(lexer.token().pos.line, 60000u / 7 + 2);
        lexer.advance();
        EXPECT_EQ(lexer.token().text, "End");
    }
}

TEST(Lexer, IntegerArrays) {
    Lexer lexer(std::make_unique<Trickle>("[1 2.0 3.5 -4 3e9]", 100), {1, 1, 1}, nullptr);
    lexer.advance();
    std::vector<std::int32_t> values;
    Lexer::IntTrouble trouble;
    ASSERT_TRUE(lexer.read_ints(values, trouble));
    EXPECT_EQ(values, (std::vector<std::int32_t>{1, 2, 3, -4, 2147483647}));
    EXPECT_EQ(trouble.inexact.col, 8u);
    EXPECT_EQ(trouble.overflow.col, 15u);
}

TEST(Lexer, MixedArrayStopsAtTheStranger) {
    Lexer lexer(std::make_unique<Trickle>("[1 \"two\" 3] X", 100), {1, 1, 1}, nullptr);
    lexer.advance();
    std::vector<float> values;
    EXPECT_FALSE(lexer.read_floats(values));
    EXPECT_EQ(lexer.token().kind, TokenKind::String);
}

TEST(Lexer, CommentsAreHandedOn) {
    std::vector<std::string> seen;
    const Lexer::CommentHandler handler = [&](const rib::Comment& c) {
        seen.push_back(std::string(c.kind) + "|" + std::string(c.text) +
                       (c.trailing ? "|trailing" : ""));
    };
    Lexer lexer(std::make_unique<Trickle>("##RenderMan RIB-Structure 1.1\nA # note\r\"#\"", 3),
                {1, 1, 1}, &handler);
    for (int i = 0; i < 3; ++i) {
        lexer.advance();
    }
    EXPECT_EQ(seen, (std::vector<std::string>{"structure|RenderMan RIB-Structure 1.1",
                                              "comment| note|trailing"}));
}

TEST(Lexer, LongRunsAreCutNotKept) {
    const auto t = tokens(std::string(400'000, '1'));
    ASSERT_FALSE(t.empty());
    for (const Token& token : t) {
        EXPECT_LT(token.text.size(), 200'000u);
    }
}

TEST(Lexer, RecordsText) {
    Lexer lexer(std::make_unique<Trickle>("Begin A 1 \"x\" [2] B 3 End", 5), {1, 1, 1}, nullptr);
    lexer.advance();
    lexer.advance();
    lexer.start_recording();
    while (lexer.token().text != "End") {
        lexer.advance();
    }
    EXPECT_EQ(lexer.stop_recording().text, "A 1 \"x\" [2] B 3 ");
}

} // namespace
