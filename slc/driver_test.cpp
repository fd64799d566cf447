// SPDX-License-Identifier: Apache-2.0
// From SL text to loaded objects: the library and its cache, damaged objects, reproducible bytes,
// the programs slc and slctell from outside.
#include "runtime/base/ar_file.h"
#include "runtime/base/file.h"
#include "runtime/base/seal.h"
#include "sl_fingerprint.h"
#include "slc/driver.h"
#include "slc/emit_runner.h"
#include "slc/process.h"

#include <atomic>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <thread>

namespace slc {
namespace {

namespace fs = std::filesystem;

constexpr const char* matte_text = "surface matte(float Ka = 1, Kd = 1;) {\n"
                                   "    normal Nf = faceforward(normalize(N), I);\n"
                                   "    Oi = Os;\n"
                                   "    Ci = Os * Cs * (Ka * ambient() + Kd * diffuse(Nf));\n"
                                   "}\n";

void write(const std::string& path, const std::string& text) {
    std::ofstream(path) << text;
}

class Driver : public ::testing::Test {
protected:
    const base::TempDir dir{"slc-test"};
    base::Diag diag{std::tmpfile()};
    rt::StringTable strings;
    ObjectOptions native = [] {
        ObjectOptions o;
        o.native_only = true;
        o.flags.optimisation = 1;
        return o;
    }();

    [[nodiscard]] std::string in(const std::string& name) const { return dir.path() + "/" + name; }

    rt::ShaderLibrary::Config config(std::atomic<int>* num_compiled = nullptr) {
        rt::ShaderLibrary::Config c;
        c.search_path = {dir.path()};
        c.trusted = {dir.path()};
        c.cache_dir = in("cache");
        c.compile = [this, num_compiled](const std::string& sl, base::Diag& d,
                                         const rt::Cancelled& cancelled) {
            *(num_compiled ? num_compiled : &ignored_) += 1;
            ObjectOptions options = native;
            options.front.cancelled = cancelled;
            return compile_to_bytes(sl, options, d);
        };
        c.cache_key = [this](const std::string& sl, base::Diag& d, const rt::Cancelled&) {
            return object_key(sl, native, d);
        };
        return c;
    }

private:
    std::atomic<int> ignored_ = 0;
};

TEST_F(Driver, ObjectsLoadOnlyFromTrustedDirectories) {
    write(in("matte.sl"), matte_text);
    ASSERT_TRUE(compile_to_object(in("matte.sl"), in("matte.slo"), native, diag));
    std::filesystem::remove(in("matte.sl"));
    rt::ShaderLibrary::Config untrusted = config();
    untrusted.trusted.clear();
    {
        rt::ShaderLibrary library(untrusted, strings, diag);
        EXPECT_EQ(library.find("matte", SL_SHADER_surface, {}), nullptr);
        EXPECT_EQ(library.find(in("matte"), SL_SHADER_surface, {}), nullptr);
        EXPECT_EQ(library.find(in("cache/../matte"), SL_SHADER_surface, {}), nullptr);
    }
    untrusted.trust_all = true;
    rt::ShaderLibrary library(untrusted, strings, diag);
    EXPECT_NE(library.find("matte", SL_SHADER_surface, {}), nullptr);
}

TEST_F(Driver, SourceIsCompiledOnceIntoTheCache) {
    write(in("matte.sl"), matte_text);
    std::atomic<int> num_compiled = 0;
    for (int run = 0; run < 2; ++run) {
        rt::ShaderLibrary library(config(&num_compiled), strings, diag);
        const rt::ShaderObject* shader = library.find("matte.slo", SL_SHADER_surface, {});
        ASSERT_NE(shader, nullptr) << diag.messages().back();
        EXPECT_STREQ(shader->object().name, "matte");
        EXPECT_EQ(library.find("matte", SL_SHADER_surface, {}), shader);
        EXPECT_EQ(shader->find_param("Kd"), 1);
    }
    EXPECT_EQ(num_compiled, 1);
    // Other text, other object.
    write(in("matte.sl"), std::string(matte_text) + "// changed\n");
    rt::ShaderLibrary library(config(&num_compiled), strings, diag);
    EXPECT_NE(library.find("matte", SL_SHADER_surface, {}), nullptr);
    EXPECT_EQ(num_compiled, 2);
    EXPECT_FALSE(diag.had_errors());
}

TEST_F(Driver, DamagedCacheEntryIsReplaced) {
    write(in("matte.sl"), matte_text);
    std::atomic<int> num_compiled = 0;
    {
        rt::ShaderLibrary library(config(&num_compiled), strings, diag);
        ASSERT_NE(library.find("matte", SL_SHADER_surface, {}), nullptr);
    }
    for (const auto& entry : fs::recursive_directory_iterator(in("cache"))) {
        if (entry.is_regular_file()) {
            fs::resize_file(entry.path(), fs::file_size(entry.path()) / 2);
        }
    }
    rt::ShaderLibrary library(config(&num_compiled), strings, diag);
    EXPECT_NE(library.find("matte", SL_SHADER_surface, {}), nullptr);
    EXPECT_EQ(num_compiled, 2);
}

TEST_F(Driver, WithoutACacheTheRunStillWorks) {
    write(in("matte.sl"), matte_text);
    auto c = config();
    c.cache_dir.clear();
    rt::ShaderLibrary library(c, strings, diag);
    EXPECT_NE(library.find("matte", SL_SHADER_surface, {}), nullptr);
}

TEST_F(Driver, ConcurrentRunsShareTheCache) {
    write(in("matte.sl"), matte_text);
    std::vector<std::jthread> runs;
    std::atomic<int> found{0};
    for (int i = 0; i < 3; ++i) {
        runs.emplace_back([&] {
            rt::ShaderLibrary library(config(), strings, diag);
            found += library.find("matte", SL_SHADER_surface, {}) != nullptr ? 1 : 0;
        });
    }
    runs.clear();
    EXPECT_EQ(found, 3);
    for (const auto& entry : fs::recursive_directory_iterator(in("cache"))) {
        EXPECT_NE(entry.path().extension(), ".tmp");
    }
}

TEST_F(Driver, MissingAndBrokenShadersAreReportedOnce) {
    write(in("broken.sl"), "surface broken( { }\n");
    rt::ShaderLibrary library(config(), strings, diag);
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(library.find("nowhere", SL_SHADER_surface, {}), nullptr);
        EXPECT_EQ(library.find(in("sub/dir/nowhere"), SL_SHADER_surface, {}), nullptr);
    }
    EXPECT_EQ(diag.count(base::Severity::Error), 2U);
    EXPECT_EQ(library.find("broken", SL_SHADER_surface, {}), nullptr);
    const auto count = diag.count(base::Severity::Error);
    EXPECT_GT(count, 2U);
    EXPECT_EQ(library.find("broken", SL_SHADER_surface, {}), nullptr);
    EXPECT_EQ(diag.count(base::Severity::Error), count);
}

TEST_F(Driver, TypesAreChecked) {
    write(in("matte.sl"), matte_text);
    rt::ShaderLibrary library(config(), strings, diag);
    EXPECT_EQ(library.find("matte", SL_SHADER_light, {}), nullptr);
    EXPECT_EQ(diag.count(base::Severity::Error), 1U);
    EXPECT_NE(library.find_any("matte", {}), nullptr);
}

TEST_F(Driver, ForeignAndDamagedObjectsAreRefused) {
    write(in("matte.sl"), matte_text);
    ASSERT_TRUE(compile_to_object(in("matte.sl"), in("good.slo"), native, diag));
    const std::string good = *base::read_file(in("good.slo"));
    rt::ShaderLibrary library(config(), strings, diag);
    ASSERT_NE(library.load(in("good.slo"), {}), nullptr);

    std::string why;
    const auto refused = [&](const std::string& bytes) {
        write(in("bad.slo"), bytes);
        return rt::ShaderObject::open(in("bad.slo"), strings, why) == nullptr && !why.empty();
    };
    EXPECT_TRUE(refused(""));
    EXPECT_TRUE(refused("not an object"));
    EXPECT_TRUE(refused(good.substr(0, good.size() / 2)));
    EXPECT_TRUE(refused(good.substr(0, good.size() - 1)));
    for (std::size_t at = 0; at < good.size(); at += good.size() / 40) {
        std::string damaged = good;
        damaged[at] = static_cast<char>(damaged[at] ^ 0x20);
        EXPECT_TRUE(refused(damaged)) << at;
    }
    // Another version's object: right in itself, but sealed with another fingerprint.
    const std::string content =
        good.substr(0, good.size() - base::seal("", SL_ABI_FINGERPRINT).size());
    EXPECT_TRUE(refused(content + base::seal(content, std::string(64, '0'))));
    EXPECT_NE(why.find("fingerprint"), std::string::npos) << why;
    // Sealed garbage: the dynamic linker's refusal becomes a message.
    EXPECT_TRUE(refused("garbage" + base::seal("garbage", SL_ABI_FINGERPRINT)));
}

TEST_F(Driver, BrokenObjectBesideItsSourceIsCompiledAnew) {
    write(in("matte.sl"), matte_text);
    write(in("matte.slo"), "old");
    rt::ShaderLibrary library(config(), strings, diag);
    EXPECT_NE(library.find("matte", SL_SHADER_surface, {}), nullptr);
    EXPECT_EQ(diag.count(base::Severity::Warning), 1U);
    EXPECT_FALSE(diag.had_errors());
}

// --- announced ahead, packages, places

TEST_F(Driver, AnnouncedShadersAreCompiledOnceAndToldInOrder) {
    constexpr int num_shaders = 6;
    for (int i = 0; i < num_shaders; ++i) {
        const std::string name = "s" + std::to_string(i);
        write(in(name + ".sl"), i % 2 == 0
                                    ? "surface " + name + "() { Ci = " + std::to_string(i) + "; }\n"
                                    : "surface " + name + "() { Ci = nothing; }\n");
    }
    std::vector<std::string> said[3];
    for (int threads = 0; threads < 3; ++threads) {
        std::FILE* out = std::tmpfile();
        base::Diag here(out);
        std::atomic<int> num_compiled = 0;
        auto c = config(&num_compiled);
        c.cache_dir = in("cache" + std::to_string(threads));
        c.num_threads = std::max(threads, 1);
        rt::ShaderLibrary library(c, strings, here);
        const base::SourcePos pos{here.file_id("scene.rib"), 7, 1};
        for (int i = 0; threads > 0 && i < 3 * num_shaders; ++i) { // three calls of each
            library.prefetch("s" + std::to_string(i % num_shaders), pos);
        }
        library.prefetch("absent", pos);
        EXPECT_TRUE(here.messages().empty()) << "nobody has asked yet";
        for (int i = num_shaders - 1; i >= 0; --i) {
            const bool found = library.find("s" + std::to_string(i), SL_SHADER_surface, pos);
            EXPECT_EQ(found, i % 2 == 0) << i;
        }
        EXPECT_EQ(library.find("absent", SL_SHADER_surface, pos), nullptr);
        EXPECT_EQ(num_compiled, num_shaders);
        said[threads] = here.messages();
        std::fclose(out);
    }
    EXPECT_EQ(said[0], said[1]);
    EXPECT_EQ(said[0], said[2]);
    EXPECT_EQ(said[0].size(), 4U);
}

TEST_F(Driver, TheSameFileByTwoPathsIsCompiledOnce) {
    write(in("matte.sl"), matte_text);
    write(in("broken.sl"), "surface broken() { Ci = nothing; }\n");
    std::atomic<int> num_compiled = 0;
    rt::ShaderLibrary library(config(&num_compiled), strings, diag);
    const std::vector<std::string> other = {in("no-such"), dir.path()};
    EXPECT_EQ(library.find("matte", SL_SHADER_surface, {}),
              library.find("matte", SL_SHADER_surface, {}, other));
    EXPECT_EQ(library.find("broken", SL_SHADER_surface, {}), nullptr);
    const auto errors = diag.count(base::Severity::Error);
    EXPECT_EQ(library.find("broken", SL_SHADER_surface, {}, other), nullptr);
    EXPECT_EQ(diag.count(base::Severity::Error), errors);
    EXPECT_EQ(num_compiled, 2);
}

TEST_F(Driver, ThePathOfTheCallDecides) {
    write(in("matte.sl"), matte_text);
    fs::create_directories(in("mine"));
    write(in("mine/matte.sl"), "surface matte(float mine = 1;) { Ci = mine; }\n");
    rt::ShaderLibrary library(config(), strings, diag);
    const auto* standard = library.find("matte", SL_SHADER_surface, {});
    const auto* mine =
        library.find("matte", SL_SHADER_surface, {}, std::vector<std::string>{in("mine")});
    ASSERT_TRUE(standard && mine);
    EXPECT_EQ(standard->find_param("mine"), -1);
    EXPECT_EQ(mine->find_param("mine"), 0);
}

TEST_F(Driver, CancelledCompilationsEndSilently) {
    write(in("matte.sl"), matte_text);
    auto c = config();
    c.interrupted = [] { return true; };
    rt::ShaderLibrary library(c, strings, diag);
    library.prefetch("matte", {});
    EXPECT_EQ(library.find("matte", SL_SHADER_surface, {}), nullptr);
    EXPECT_TRUE(diag.messages().empty());
    ObjectOptions options = native;
    options.front.cancelled = c.interrupted;
    EXPECT_EQ(compile_to_bytes(in("matte.sl"), options, diag), std::nullopt);
    EXPECT_TRUE(diag.messages().empty());
}

TEST_F(Driver, CancellingEndsTheWholeGroupOfProcesses) {
    int calls = 0;
    ProcessSettings settings;
    settings.cancelled = [&calls] { return ++calls > 2; };
    // The shell's child holds the pipe too: only ending both lets run_process return.
    const ProcessResult result = run_process({"sh", "-c", "sleep 1000; true"}, "", settings);
    EXPECT_TRUE(result.cancelled);
    EXPECT_EQ(result.exit_code, -1);
}

TEST_F(Driver, AnUnwritableCacheIsStillRead) {
    write(in("matte.sl"), matte_text);
    write(in("file"), "no directory");
    std::atomic<int> num_compiled = 0;
    auto c = config(&num_compiled);
    c.cache_dir = in("file/cache");
    for (int run = 0; run < 2; ++run) {
        rt::ShaderLibrary library(c, strings, diag);
        EXPECT_NE(library.find("matte", SL_SHADER_surface, {}), nullptr);
    }
    EXPECT_EQ(num_compiled, 2);
    EXPECT_EQ(diag.count(base::Severity::Warning), 1U);
    EXPECT_FALSE(diag.had_errors());
}

TEST_F(Driver, PackagesServeWhereDirectoriesDo) {
    std::vector<std::pair<std::string, std::string>> members;
    for (const char* name : {"one", "two", "a_shader_with_quite_a_long_name"}) {
        write(in("x.sl"), std::string("surface ") + name + "() { Ci = 1; }\n");
        auto bytes = compile_to_bytes(in("x.sl"), native, diag);
        ASSERT_TRUE(bytes);
        members.emplace_back(std::string(name) + ".slo", std::move(*bytes));
    }
    members.emplace_back("damaged.slo", members[0].second.substr(0, 1000));
    write(in("lib.slpkg"), base::ar_bytes(members));
    auto c = config();
    c.search_path = {in("no-such"), in("lib.slpkg"), dir.path()};
    {
        c.trusted = {in("lib.slpkg")};
        rt::ShaderLibrary library(c, strings, diag);
        const auto* one = library.find("one", SL_SHADER_surface, {});
        const auto* two = library.find("two.slo", SL_SHADER_surface, {});
        ASSERT_TRUE(one && two);
        EXPECT_STREQ(one->object().name, "one");
        EXPECT_STREQ(two->object().name, "two");
        EXPECT_NE(library.find("a_shader_with_quite_a_long_name", SL_SHADER_surface, {}), nullptr);
        EXPECT_EQ(library.find(in("lib.slpkg/one"), SL_SHADER_surface, {}), one);
        EXPECT_FALSE(diag.had_errors());
        EXPECT_EQ(library.find("damaged", SL_SHADER_surface, {}), nullptr);
        EXPECT_EQ(diag.count(base::Severity::Error), 1U);
    }
    c.trusted = {in("elsewhere")};
    rt::ShaderLibrary library(c, strings, diag);
    EXPECT_EQ(library.find("one", SL_SHADER_surface, {}), nullptr);
    EXPECT_EQ(diag.count(base::Severity::Warning), 1U);
}

TEST_F(Driver, AFileThatIsNoPackageIsToldOnce) {
    write(in("matte.sl"), matte_text);
    write(in("text"), "no package");
    auto c = config();
    c.search_path = {in("text"), dir.path()};
    rt::ShaderLibrary library(c, strings, diag);
    EXPECT_NE(library.find("matte", SL_SHADER_surface, {}), nullptr);
    EXPECT_EQ(library.find("absent", SL_SHADER_surface, {}), nullptr);
    EXPECT_EQ(diag.count(base::Severity::Warning), 1U);
}

// --- the programs

class Programs : public Driver {
protected:
    ProcessResult slc(std::vector<std::string> arguments) {
        return run("slc", std::move(arguments));
    }
    ProcessResult slctell(std::vector<std::string> arguments) {
        return run("slctell", std::move(arguments));
    }

private:
    static ProcessResult run(const std::string& program, std::vector<std::string> arguments) {
        const fs::path here = fs::read_symlink("/proc/self/exe").parent_path();
        arguments.insert(arguments.begin(), (here / program).string());
        return run_process(arguments, "");
    }
};

TEST_F(Programs, BytesDependOnTheSourceAlone) {
    fs::create_directories(in("a"));
    fs::create_directories(in("b/deeper"));
    write(in("a/matte.sl"), matte_text);
    write(in("b/deeper/matte.sl"), matte_text);
    EXPECT_EQ(slc({"-q", "-d", in("a"), in("a/matte.sl")}).exit_code, 0);
    const auto first = base::read_file(in("a/matte.slo"));
    EXPECT_EQ(slc({"-q", "-d", in("a"), in("a/matte.sl")}).exit_code, 0);
    EXPECT_EQ(first, base::read_file(in("a/matte.slo"))) << "the same bytes twice";
    EXPECT_EQ(slc({"-q", "-o", in("b/other.slo"), in("b/deeper/../deeper/matte.sl")}).exit_code, 0);
    EXPECT_EQ(first, base::read_file(in("b/other.slo"))) << "the same bytes from anywhere";
}

TEST_F(Programs, ExitCodesAndLeftovers) {
    write(in("good.sl"), matte_text);
    write(in("bad.sl"), "surface bad() { Ci = ; }\n");
    write(in("two.sl"), "surface one() { Ci = 1; }\nlight two() { Cl = 1; }\n");
    EXPECT_EQ(slc({"--help"}).exit_code, 0);
    EXPECT_EQ(slc({"--version"}).exit_code, 0);
    EXPECT_EQ(slc({}).exit_code, 2);
    EXPECT_EQ(slc({"--nonsense", in("good.sl")}).exit_code, 2);
    EXPECT_EQ(slc({"-j", "many", in("good.sl")}).exit_code, 2);
    const ProcessResult opencl = slc({"--target=opencl", in("good.sl")});
    EXPECT_EQ(opencl.exit_code, 2);
    EXPECT_NE(opencl.err.find("not part of this version"), std::string::npos);
    EXPECT_EQ(slc({in("absent.sl")}).exit_code, 1);
    EXPECT_EQ(slc({"--cc=" + in("no-compiler"), in("good.sl")}).exit_code, 3);

    write(in("bad.slo"), "left from before");
    EXPECT_EQ(slc({"-d", dir.path(), in("bad.sl")}).exit_code, 1);
    EXPECT_FALSE(fs::exists(in("bad.slo")));
    EXPECT_EQ(slc({"--check", in("two.sl")}).exit_code, 0);
    EXPECT_EQ(slc({"-o", in("x.slo"), in("two.sl")}).exit_code, 1);
    EXPECT_EQ(slc({"-d", dir.path(), in("two.sl")}).exit_code, 0);
    EXPECT_TRUE(fs::exists(in("one.slo")));
    EXPECT_TRUE(fs::exists(in("two.slo")));
    EXPECT_EQ(slc({"-d", in("no/such/dir"), in("good.sl")}).exit_code, 3);
}

TEST_F(Programs, MessagesComeInTheOrderOfTheFiles) {
    std::vector<std::string> arguments = {"-j", "4", "--check"};
    for (int i = 0; i < 6; ++i) {
        const std::string path = in("bad" + std::to_string(i) + ".sl");
        write(path, "surface bad() { Ci = nothing; }\n");
        arguments.push_back(path);
    }
    const ProcessResult result = slc(arguments);
    EXPECT_EQ(result.exit_code, 1);
    std::size_t at = 0;
    for (int i = 0; i < 6; ++i) {
        at = result.err.find("bad" + std::to_string(i) + ".sl:1:", at);
        EXPECT_NE(at, std::string::npos) << result.err;
    }
}

TEST_F(Programs, MessagesAsJson) {
    write(in("bad.sl"),
          "surface bad() {\n  Ci = nois(P) + \"a\\\\\";\n  float x;\n  float x = P;\n}\n");
    const ProcessResult result = slc({"--check", "--messages=json", in("bad.sl")});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.err, "");
    EXPECT_NE(result.out.find("bad.sl\", \"line\": 2, \"column\": 8, \"endColumn\": 12, "
                              "\"severity\": \"error\", \"code\": \"RIE_SYNTAX\", \"text\": "
                              "\"function 'nois' is not defined, did you mean 'noise'?\"}\n"),
              std::string::npos)
        << result.out;
    EXPECT_NE(result.out.find("\"note\": \"this one is used from here on\"}"), std::string::npos)
        << result.out;
    write(in("good.sl"), matte_text);
    const ProcessResult good = slc({"--check", "--messages=json", in("good.sl")});
    EXPECT_EQ(good.exit_code, 0);
    EXPECT_EQ(good.out + good.err, "");
    EXPECT_EQ(slc({"--messages=xml", in("good.sl")}).exit_code, 2);
}

TEST_F(Programs, TellPrintsTheInterface) {
    write(in("told.sl"),
          "light told(float intensity = 2 * 0.5; color lightcolor = 1; point from = point "
          "\"shader\" (0, 1, 0);\n"
          "           string map = \"a\\\"b\"; varying vector v = 1; output float used = 0;\n"
          "           float m[3] = {1, 2, 3};) {\n"
          "    illuminate(from) { Cl = intensity * lightcolor / (L . L); used = 1; }\n}\n");
    EXPECT_EQ(slc({"-q", "-d", dir.path(), in("told.sl")}).exit_code, 0);
    const ProcessResult text = slctell({in("told.slo")});
    EXPECT_EQ(text.exit_code, 0);
    EXPECT_EQ(
        text.out,
        "light \"told\"\n"
        "    \"intensity\" \"parameter uniform float\"\n        Default value: 1\n"
        "    \"lightcolor\" \"parameter uniform color\"\n        Default value: \"rgb\" [1 1 1]\n"
        "    \"from\" \"parameter uniform point\"\n        Default value: \"shader\" [0 1 0]\n"
        "    \"map\" \"parameter uniform string\"\n        Default value: \"a\\\"b\"\n"
        "    \"v\" \"parameter varying vector\"\n        Default value: \"current\" [1 1 1]\n"
        "    \"used\" \"output parameter uniform float\"\n        Default value: 0\n"
        "    \"m\" \"parameter uniform float[3]\"\n        Default value: [1 2 3]\n"
        "    needs: Ps\n    sets: L Cl\n");
    const ProcessResult json = slctell({"--json", in("told.slo")});
    EXPECT_EQ(json.exit_code, 0);
    EXPECT_NE(json.out.find("\"default\": [0, 1, 0]"), std::string::npos) << json.out;
    EXPECT_NE(json.out.find("\"space\": \"shader\""), std::string::npos) << json.out;
    EXPECT_EQ(slctell({in("absent.slo")}).exit_code, 1);
    EXPECT_EQ(slctell({}).exit_code, 2);
}

} // namespace
} // namespace slc
