// SPDX-License-Identifier: Apache-2.0
// The system's preprocessor and the places of messages that come through it (sl.md 1.2).
#include "runtime/base/temp_dir.h"
#include "slc/process.h"
#include "slc/slc_testing.h"

#include <filesystem>
#include <fstream>

namespace slc {
namespace {

using testing::QuietDiag;
namespace fs = std::filesystem;

// A directory of files that goes away again.
class Files {
public:
    std::string write(const std::string& name, const std::string& text) const {
        fs::create_directories((dir_ / name).parent_path());
        std::ofstream(dir_ / name, std::ios::binary) << text;
        return (dir_ / name).string();
    }
    [[nodiscard]] std::string path(const std::string& name) const { return (dir_ / name).string(); }

private:
    base::TempDir temp_{"slc-test"};
    fs::path dir_ = temp_.path();
};

struct Result {
    std::size_t errors;
    std::string messages;
    std::vector<Program> programs;
};

Result compile(const std::string& path, const CompileOptions& options = {}) {
    QuietDiag diag;
    Unit unit = compile_file(path, options, diag.get());
    return {unit.num_errors, diag.text(), std::move(unit.programs)};
}

TEST(Preprocess, IncludesMacrosAndDefines) {
    const Files files;
    files.write("near.h", "#define GAIN 2\n#include <far.h>\n");
    files.write("lib/far.h", "float twice(float x) { return x * GAIN; }\n");
    const std::string main = files.write(
        "a.sl", "#include \"near.h\"\n"
                "#ifdef BMRT\n#ifdef PERIGEE\n#ifdef linux\n#error system macro\n#endif\n"
                "surface a(float k = LEVEL;) { Ci = twice(k) * PI; }\n#endif\n#endif\n");
    CompileOptions options;
    options.include_dirs = {files.path("lib")};
    options.defines = {"LEVEL=3"};
    const Result r = compile(main, options);
    EXPECT_EQ(r.errors, 0U) << r.messages;
    ASSERT_EQ(r.programs.size(), 1U);
    EXPECT_EQ(r.programs[0].name, "a");
}

TEST(Preprocess, DosLineEndsMarkAndEndOfFile) {
    const Files files;
    const std::string main =
        files.write("dos.sl", "\xef\xbb\xbf#define A \\\r\n 1\r\nsurface dos()\r\n{\r\n  Ci = A; "
                              "// done\r\n  Oi = x;\r\n}\r\n\x1a");
    const Result r = compile(main);
    EXPECT_NE(r.messages.find("dos.sl:6:8: error: 'x' is not declared"), std::string::npos)
        << r.messages;
}

TEST(Preprocess, ColumnsSurviveSpacingCommentsAndMacros) {
    const Files files;
    const std::string main =
        files.write("c.sl", "#define TWICE(x) (2 * (x) + 0)\n"
                            "surface c() {\n"
                            "\tCi   =  TWICE( 1 ) /* a (comment) */   +    missing;\n}\n");
    const Result r = compile(main);
    EXPECT_NE(r.messages.find("c.sl:3:46: error: 'missing' is not declared"), std::string::npos)
        << r.messages;
    EXPECT_NE(r.messages.find("\n\tCi   =  TWICE( 1 ) /* a (comment) */   +    missing;\n\t"),
              std::string::npos);
}

TEST(Preprocess, MissingIncludeNamesTheFile) {
    const Files files;
    const Result r =
        compile(files.write("m.sl", "surface m() { Ci = 0; }\n#include \"noises.h\"\n"));
    EXPECT_EQ(r.errors, 1U);
    EXPECT_NE(r.messages.find("m.sl:2:"), std::string::npos) << r.messages;
    EXPECT_NE(r.messages.find("noises.h"), std::string::npos) << r.messages;
    EXPECT_TRUE(r.programs.empty());
}

TEST(Preprocess, ErrorsInsideIncludesNameTheInclude) {
    const Files files;
    files.write("inner.h", "\n\nfloat f(float x) { return y; }\n");
    const Result r =
        compile(files.write("outer.sl", "#include \"inner.h\"\nsurface s() { Ci = f(1) }\n"));
    EXPECT_NE(r.messages.find("inner.h:3:27: error: 'y' is not declared"), std::string::npos)
        << r.messages;
    EXPECT_NE(r.messages.find("outer.sl:2:25: error: expected ';'"), std::string::npos)
        << r.messages;
}

TEST(Preprocess, DirectivesOfTheSource) {
    const Files files;
    const Result r =
        compile(files.write("d.sl", "#pragma annotation \"a\" \"b\"\n#sounds like\n"
                                    "#line 40 \"elsewhere.sl\"\nsurface d() { Ci = q; }\n"));
    EXPECT_NE(r.messages.find("elsewhere.sl:40"), std::string::npos) << r.messages;
    EXPECT_NE(r.messages.find("d.sl:2:2: warning: invalid preprocessing directive"),
              std::string::npos)
        << r.messages;
}

TEST(Preprocess, ErrorDirective) {
    const Files files;
    const Result r = compile(files.write("e.sl", "#error not for this renderer\n"));
    EXPECT_EQ(r.errors, 1U);
    EXPECT_NE(r.messages.find("not for this renderer"), std::string::npos) << r.messages;
}

TEST(Preprocess, NoCompilerSaysWhatToInstall) {
    const Files files;
    CompileOptions options;
    options.preprocessor = "/nonexistent/cc";
    const Result r = compile(files.write("n.sl", "surface n() {}\n"), options);
    EXPECT_EQ(r.errors, 1U);
    EXPECT_NE(r.messages.find("apt-get install gcc"), std::string::npos) << r.messages;
}

TEST(Preprocess, MissingFileAndDirectory) {
    EXPECT_NE(compile("/nonexistent/x.sl").messages.find("cannot read '/nonexistent/x.sl'"),
              std::string::npos);
    EXPECT_NE(compile("/tmp").messages.find("cannot read"), std::string::npos);
}

TEST(Preprocess, FileNamesNeedNoQuoting) {
    const Files files;
    files.write("od d/in \"c.h", "#define K 1\n");
    const Result r = compile(files.write("od d/$(touch x) 'y\".sl", "surface n() { Ci = 1; }\n"));
    EXPECT_EQ(r.errors, 0U) << r.messages;
}

TEST(Preprocess, ExplosionIsStopped) {
    const Files files;
    std::string text = "#define A0 1 1 1 1 1 1 1 1 1 1\n";
    for (int i = 1; i < 10; ++i) {
        const std::string inner = " A" + std::to_string(i - 1);
        text += "#define A" + std::to_string(i);
        for (int k = 0; k < 10; ++k) {
            text += inner;
        }
        text += "\n";
    }
    ProcessSettings limits;
    limits.output_bytes = 1 << 16;
    limits.cpu_seconds = 5;
    limits.memory_bytes = 1U << 30;
    const ProcessResult direct =
        run_process({"sh", "-c", "while :; do echo yyyyyyyyyyyyyyyy; done"}, "", limits);
    EXPECT_TRUE(direct.cut_off);
    EXPECT_LE(direct.out.size(), 1U << 16);
    const Result r = compile(files.write("bomb.sl", "surface b() { Ci = 1; }\n" + text));
    EXPECT_EQ(r.errors, 0U) << r.messages; // defined but not used: harmless
}

} // namespace
} // namespace slc
