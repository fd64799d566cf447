// SPDX-License-Identifier: Apache-2.0
// What is written is read back as the same requests, to the last bit of every number: every row of
// the table, with examples and with arguments drawn at random, in text and binary.
#include "ribtools/request_examples.h"
#include "ribtools/rib_convert.h"
#include "ribtools/rib_gzip.h"
#include "ribtools/rib_parse.h"
#include "ribtools/rib_write.h"
#include "ribtools/scene_dump.h"
#include "ribtools/test_util.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <limits>
#include <random>

namespace {

using rib::Request;
using rib::RibForm;
using rib_test::Reading;
using rib_test::world;

template <class T> bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

bool same(const rib::Arg& a, const rib::Arg& b) {
    return a.given == b.given && same_bits(a.numbers, b.numbers) && same_bits(a.ints, b.ints) &&
           same_bits(a.floats, b.floats) && a.strings == b.strings;
}

bool same(const rib::Param& a, const rib::Param& b) {
    return a.name == b.name && same_bits(a.floats, b.floats) && same_bits(a.ints, b.ints) &&
           a.strings == b.strings;
}

bool same(const rib::LooseValue& a, const rib::LooseValue& b) {
    return a.is_array == b.is_array && same_bits(a.numbers, b.numbers) && a.strings == b.strings;
}

template <class T> bool same(const std::vector<T>& a, const std::vector<T>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const T& x, const T& y) { return same(x, y); });
}

bool same(const Request& a, const Request& b) {
    bool equal = a.id == b.id && a.name == b.name && same(a.values, b.values) &&
                 same(a.params.params, b.params.params);
    for (std::size_t i = 0; i < a.args.size(); ++i) {
        equal = equal && same(a.args[i], b.args[i]);
    }
    return equal;
}

std::string write(const std::vector<Request>& requests, rib::WriteOptions options) {
    std::string out;
    const auto sink = rib::memory_sink(out);
    rib::Writer writer(*sink, options);
    for (const Request& r : requests) {
        writer.request(r);
    }
    writer.flush();
    return out;
}

// The requests of a stream as they are written; messages go to *said.
std::vector<Request> read(const std::string& stream, std::string* said = nullptr) {
    std::FILE* null = std::fopen("/dev/null", "w");
    std::vector<Request> requests;
    {
        base::Diag diag(null);
        rib::Dictionary dictionary;
        const rib::ColorModel colors;
        rib::Lexer lexer(rib::open_memory(std::make_shared<const std::string>(stream)),
                         {diag.file_id("t"), 1, 1}, nullptr);
        rib::Parser parser(lexer, diag, dictionary, colors, rib::ParseMode::Keep);
        Request request;
        while (parser.next(request)) {
            requests.push_back(request);
        }
        for (const std::string& m : diag.messages()) {
            if (said) {
                *said += m + "\n";
            }
        }
    }
    std::fclose(null);
    return requests;
}

void expect_round_trip(const std::vector<Request>& requests) {
    for (const rib::WriteOptions options :
         {rib::WriteOptions{RibForm::Text, 0}, rib::WriteOptions{RibForm::Text, 3},
          rib::WriteOptions{RibForm::Binary, 0}}) {
        const std::string stream = write(requests, options);
        const std::vector<Request> again = read(stream);
        ASSERT_EQ(again.size(), requests.size()) << stream;
        for (std::size_t i = 0; i < again.size(); ++i) {
            EXPECT_TRUE(same(requests[i], again[i]))
                << rib::row(requests[i].id).name << " " << i << "\n"
                << (options.form == RibForm::Text ? stream : "(binary)");
        }
    }
}

std::string convert(const std::string& stream, rib::WriteOptions options, bool gzip = false) {
    std::FILE* null = std::fopen("/dev/null", "w");
    std::string out;
    {
        base::Diag diag(null);
        auto sink = rib::memory_sink(out);
        if (gzip) {
            sink = rib::gzip_sink(std::move(sink));
        }
        rib::Writer writer(*sink, options);
        rib::Converter converter(writer, diag, {});
        (void)converter.convert(
            rib::open_gzip(rib::open_memory(std::make_shared<const std::string>(stream))), "t");
        writer.flush();
        EXPECT_TRUE(sink->finish());
    }
    std::fclose(null);
    return out;
}

std::string to_text(const std::string& stream) {
    return convert(stream, {RibForm::Text, 0});
}

// --- every request of the table ---

TEST(Write, ExamplesOfEveryRequest) {
    for (const rib_test::Example& e : rib_test::examples) {
        std::string said;
        const std::vector<Request> requests = read(e.text, &said);
        EXPECT_EQ(said, "") << e.text;
        EXPECT_TRUE(std::any_of(requests.begin(), requests.end(), [&](const Request& r) {
            return rib::row(r.id).name == e.name;
        })) << e.name;
        expect_round_trip(requests);
    }
}

// Text -> binary -> text -> gzipped binary -> text gives the same text, and the same scene as the
// stream it began with.
void expect_same_scenes(const std::string& stream, const std::string& name) {
    const std::string text = to_text(stream);
    const std::string binary = convert(text, {RibForm::Binary, 0});
    EXPECT_EQ(to_text(binary), text) << name;
    EXPECT_EQ(to_text(convert(binary, {RibForm::Binary, 0}, true)), text) << name;
    EXPECT_EQ(to_text(convert(text, {RibForm::Text, 2}, true)), text) << name;
    const Reading a(stream), b(text), c(binary);
    EXPECT_EQ(b.messages.size(), c.messages.size()) << name << "\n" << b.said() << c.said();
    ASSERT_EQ(a.backend.scenes.size(), b.backend.scenes.size()) << name;
    ASSERT_EQ(a.backend.scenes.size(), c.backend.scenes.size()) << name;
    for (std::size_t i = 0; i < a.backend.scenes.size(); ++i) {
        const std::string scene = rib::dump(*a.backend.scenes[i]);
        EXPECT_EQ(scene, rib::dump(*b.backend.scenes[i])) << name;
        EXPECT_EQ(scene, rib::dump(*c.backend.scenes[i])) << name;
    }
}

TEST(Write, AllFormsMakeTheSameScene) {
    for (const rib_test::Example& e : rib_test::examples) {
        expect_same_scenes(e.text, e.name);
        EXPECT_EQ(Reading(e.text).messages.size(), Reading(to_text(e.text)).messages.size());
    }
}

TEST(Write, AllFormsOfTheSuite) {
    std::size_t num_files = 0;
    for (const char* folder : {"/testsuite/cases", "/examples"}) {
        for (const auto& entry :
             std::filesystem::recursive_directory_iterator(std::string(SOURCE_ROOT) + folder)) {
            if (entry.path().extension() == ".rib") {
                std::ifstream file(entry.path(), std::ios::binary);
                const std::string stream{std::istreambuf_iterator<char>(file), {}};
                expect_same_scenes(stream, entry.path().string());
                ++num_files;
            }
        }
    }
    EXPECT_GT(num_files, 100u);
}

// --- arguments at random ---

class Random {
public:
    explicit Random(unsigned seed) : engine_(seed) {}

    std::uint64_t bits() { return engine_(); }
    std::size_t below(std::size_t n) { return engine_() % n; }
    double real() {
        static constexpr double special[] = {0,
                                             -0.0,
                                             1,
                                             -1,
                                             .5,
                                             -.5625,
                                             255,
                                             256,
                                             -32768,
                                             32768,
                                             1e-45,
                                             1e38,
                                             0.1,
                                             1e7,
                                             16777217,
                                             2147483647,
                                             -2147483648.0,
                                             4294967296.0,
                                             5e-324,
                                             std::numeric_limits<double>::max(),
                                             std::numeric_limits<float>::max(),
                                             std::numeric_limits<float>::min(),
                                             std::numeric_limits<float>::denorm_min()};
        switch (below(4)) {
        case 0:
            return special[below(std::size(special))];
        case 1:
            return static_cast<double>(single());
        case 2:
            return static_cast<double>(static_cast<std::int32_t>(bits() >> (32 + below(32)))) /
                   std::ldexp(1., static_cast<int>(8 * below(4)));
        default: {
            const double x = std::bit_cast<double>(bits());
            return std::isfinite(x) ? x : .25;
        }
        }
    }
    float single() {
        const float x = std::bit_cast<float>(static_cast<std::uint32_t>(bits()));
        return std::isfinite(x) ? x : -0.0f;
    }
    std::int32_t integer() { return static_cast<std::int32_t>(bits() >> (32 + below(32))); }
    std::string text() {
        std::string out(below(5) == 0 ? below(400) : below(20), ' ');
        for (char& c : out) {
            c = static_cast<char>(below(3) == 0 ? bits() : 'a' + below(26));
        }
        return out;
    }
    template <class T, class Make> std::vector<T> some(Make make) {
        std::vector<T> out(below(3) == 0 ? below(300) : below(6));
        for (T& x : out) {
            x = make();
        }
        return out;
    }
    template <class T, class Make> std::vector<T> just(std::size_t n, Make make) {
        std::vector<T> out(n);
        for (T& x : out) {
            x = make();
        }
        return out;
    }

private:
    std::mt19937_64 engine_;
};

rib::Arg random_arg(char code, Random& random) {
    rib::Arg arg;
    arg.given = true;
    const auto real = [&] { return random.real(); };
    switch (code) {
    case 'i':
        arg.ints = {random.integer()};
        break;
    case 'f':
    case 'v':
        arg.numbers = {random.real()};
        break;
    case 'c':
        arg.numbers = random.just<double>(1 + random.below(5), real);
        break;
    case 'b':
        arg.numbers = random.just<double>(6, real);
        break;
    case 'B':
        if (random.below(2) == 0) {
            arg.strings = {random.text()};
            break;
        }
        [[fallthrough]];
    case 'm':
        arg.numbers = random.just<double>(16, real);
        break;
    case 'h':
        arg.strings = {random.below(2) == 0 ? random.text() : std::to_string(random.integer())};
        break;
    case 's':
        arg.strings = {random.text()};
        break;
    case 'S':
        arg.strings = random.some<std::string>([&] { return random.text(); });
        break;
    case 'I':
        arg.ints = random.some<std::int32_t>([&] { return random.integer(); });
        break;
    default:
        arg.floats = random.some<float>([&] { return random.single(); });
        break;
    }
    return arg;
}

rib::Param random_param(Random& random) {
    rib::Param p;
    switch (random.below(3)) {
    case 0:
        p.name = "varying float[2] x" + std::to_string(random.below(9));
        p.floats = random.some<float>([&] { return random.single(); });
        break;
    case 1:
        p.name = "uniform integer n" + std::to_string(random.below(9));
        p.ints = random.some<std::int32_t>([&] { return random.integer(); });
        break;
    default:
        p.name = "string s" + std::to_string(random.below(9));
        p.strings = random.some<std::string>([&] { return random.text(); });
        break;
    }
    return p;
}

// Some of the optional arguments, all or none of a group.
Request random_request(rib::RequestId id, Random& random) {
    Request r;
    r.id = id;
    const rib::RequestRow& row = rib::row(id);
    std::size_t index = 0;
    bool with_group = true;
    for (std::size_t k = 0; k < row.args.size(); ++k) {
        const char code = row.args[k];
        if (code == '(') {
            with_group = random.below(2) == 0;
        } else if (code != ')' && code != '?') {
            const bool optional = k + 1 < row.args.size() && row.args[k + 1] == '?';
            if (with_group && (!optional || random.below(2) == 0)) {
                r.args[index] = random_arg(code, random);
            }
            ++index;
        }
    }
    // Without its string a handle or shader would be taken from the parameter list.
    const bool complete = row.args.find('?') == std::string_view::npos || r.args[index - 1].given;
    for (std::size_t n = random.below(4); row.params != rib::ParamUse::None && complete && n > 0;
         --n) {
        r.params.params.push_back(random_param(random));
    }
    return r;
}

TEST(Write, RandomArgumentsOfEveryRequest) {
    Random random(7);
    for (std::size_t i = 0; i < rib::request_table().size(); ++i) {
        const auto id = static_cast<rib::RequestId>(i);
        if (rib::row(id).kind == rib::RequestKind::Skipped) {
            continue;
        }
        std::vector<Request> requests;
        for (int k = 0; k < 20; ++k) {
            requests.push_back(random_request(id, random));
        }
        expect_round_trip(requests);
    }
}

TEST(Write, RequestsOutsideTheTable) {
    Random random(11);
    std::vector<Request> requests;
    for (std::size_t i = 0; i < 400; ++i) {
        Request r;
        r.id = i % 4 == 0 ? rib::RequestId::Pattern : rib::RequestId::Unknown;
        r.name = i % 4 == 0 ? "Pattern" : "User:Request" + std::to_string(i);
        for (std::size_t n = random.below(5); n > 0; --n) {
            rib::LooseValue v;
            v.is_array = random.below(2) == 0;
            const std::size_t size = v.is_array ? random.below(9) : 1;
            if (random.below(2) == 0) {
                v.numbers = random.just<double>(size, [&] { return random.real(); });
            } else {
                v.strings = random.just<std::string>(size, [&] { return random.text(); });
            }
            r.values.push_back(std::move(v));
        }
        requests.push_back(std::move(r));
    }
    expect_round_trip(requests);
}

// --- single rules ---

TEST(Write, TextIsTheShortestThatIsTheSame) {
    EXPECT_EQ(to_text("Translate 0.1000 1e0 -0.0 Scale 1e6 100000000000 .33333333333333333"),
              "Translate 0.1 1 -0\nScale 1000000 1e+11 0.3333333333333333\n");
    EXPECT_EQ(to_text("MotionBegin [0.1 .33333333333 16777217]"),
              "MotionBegin [0.1 0.33333334 16777216]\n");
}

TEST(Write, NumbersTakeTheirShortestBinaryForm) {
    const auto size = [](const std::string& number) {
        // A request code and its definition come first: cc 00 93 S k e w... is the same every time.
        return convert("ShadingRate " + number, {RibForm::Binary, 0}).size() -
               convert("ShadingRate 0", {RibForm::Binary, 0}).size() + 2;
    };
    EXPECT_EQ(size("127"), 2u);
    EXPECT_EQ(size("-128"), 2u);
    EXPECT_EQ(size("128"), 3u);
    EXPECT_EQ(size("1e7"), 5u);
    EXPECT_EQ(size(".5"), 3u);
    EXPECT_EQ(size("-.5"), 2u);
    EXPECT_EQ(size("0.0999908447265625"), 3u);
    EXPECT_EQ(size("-0"), 5u);
    EXPECT_EQ(size("1e10"), 5u);
    EXPECT_EQ(size("0.1"), 9u);
}

TEST(Write, OtherNumbersThanFiniteOnesAreReplaced) {
    Request r;
    r.id = rib::RequestId::Translate;
    for (std::size_t i = 0; i < 3; ++i) {
        r.args[i].given = true;
        r.args[i].numbers = {i == 0 ? std::nan("") : i == 1 ? HUGE_VAL : -HUGE_VAL};
    }
    std::string out;
    const auto sink = rib::memory_sink(out);
    rib::Writer writer(*sink, {});
    writer.request(r);
    writer.flush();
    EXPECT_EQ(out, "Translate 0 3.4028234663852886e+38 -3.4028234663852886e+38\n");
    EXPECT_EQ(writer.num_not_finite(), 3u);
}

TEST(Write, OtherNumbersThanFiniteOnesAreReplacedWhenRead) {
    EXPECT_EQ(to_text("Polygon \"P\" \xc8\x02\x7f\xc0\x01\x01\xff\x80" + std::string(2, '\0')),
              "Polygon \"P\" [0 -3.4028235e+38]\n");
}

TEST(Write, StringsKeepEveryByte) {
    std::string text = "Option \"a\" \"string s\" [\"";
    for (int i = 1; i < 256; ++i) {
        char octal[8];
        std::snprintf(octal, sizeof octal, "\\%03o", static_cast<unsigned>(i));
        text += octal;
    }
    const std::vector<Request> requests = read(text + "\\000\"]");
    ASSERT_EQ(requests.at(0).params.params.at(0).strings.at(0).size(), 256u);
    expect_round_trip(requests);
}

TEST(Write, RepeatedStringsAndNamesBecomeCodes) {
    std::string text;
    for (int i = 0; i < 1000; ++i) {
        text += "Attribute \"identifier\" \"string name\" [\"n" + std::to_string(i % 300) + "\"]\n";
    }
    const std::string binary = convert(text, {RibForm::Binary, 0});
    EXPECT_LT(binary.size(), 16'000u);
    EXPECT_EQ(to_text(binary), text);
}

TEST(Write, CommentsStayWhereTheyWere) {
    const std::string text = "##RenderMan RIB-Structure 1.1\n"
                             "# by hand\n"
                             "version 3.03 # trailing\n"
                             "##Include other.rib\n"
                             "WorldBegin #[1 \"\\\n"
                             "WorldEnd\n"
                             "#last\n";
    EXPECT_EQ(to_text(text), text);
    const std::string binary = convert(text, {RibForm::Binary, 0});
    EXPECT_EQ(to_text(binary), text);
    // Inside a request there is no place: behind it.
    EXPECT_EQ(to_text("Translate 1 # x\n2 3\nSides 1"), "Translate 1 2 3 # x\nSides 1\n");
}

TEST(Write, IndentationFollowsBlocks) {
    EXPECT_EQ(convert("WorldBegin AttributeBegin IfBegin \"1\" Sides 1 Else Sides 2 IfEnd "
                      "AttributeEnd WorldEnd WorldEnd",
                      {RibForm::Text, 2}),
              "WorldBegin\n  AttributeBegin\n    IfBegin \"1\"\n      Sides 1\n    Else\n"
              "      Sides 2\n    IfEnd\n  AttributeEnd\nWorldEnd\nWorldEnd\n");
}

TEST(Write, NothingIsCarriedOut) {
    const std::string text = "ArchiveBegin \"a\"\n"
                             "Sphere 1 -1 1 360\n"
                             "ArchiveEnd\n"
                             "IfBegin \"0\"\n"
                             "ReadArchive \"a\"\n"
                             "ElseIf \"1\"\n"
                             "ReadArchive \"nowhere.rib\"\n"
                             "IfEnd\n"
                             "ArchiveRecord \"comment\" \"text\"\n"
                             "ColorSamples [1 1 1] [0.3 0.6 0.1]\n"
                             "Color [0.5]\n"
                             "Polygon \"P\" [0 0 0 1 0 0 0 1 0] \"undeclared\" [16777217]\n"
                             "Surface \"x\" \"Kd\" [0.5] \"Kd\" [0.25] \"color c\" [0.1]\n";
    EXPECT_EQ(to_text(text), text);
}

TEST(Write, VerbatimStandsAsItIs) {
    std::string out;
    const auto sink = rib::memory_sink(out);
    rib::Writer writer(*sink, {});
    writer.record("structure", "RenderMan RIB-Structure 1.1");
    writer.record("comment", "two\nlines");
    writer.record("verbatim", "Sides 1 ");
    writer.flush();
    EXPECT_EQ(out, "##RenderMan RIB-Structure 1.1\n#two\n#lines\nSides 1 \n");
}

TEST(Write, MalformedRequestsAreLeftOut) {
    EXPECT_EQ(to_text("Translate 1 2 3 4 Sides 1 Surface 5 Sides 2 Foo [1 \"x\"] Sides 1"),
              "Sides 1\nSides 2\nSides 1\n");
}

} // namespace
