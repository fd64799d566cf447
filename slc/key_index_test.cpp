// SPDX-License-Identifier: Apache-2.0
// Cache keys of shaders that include files: whatever would change the preprocessed text changes the
// key, with the index as without it.
#include "runtime/base/file.h"
#include "runtime/base/sha256.h"
#include "runtime/base/temp_dir.h"
#include "slc/driver.h"
#include "slc/key_index.h"

#include <filesystem>
#include <gtest/gtest.h>

namespace slc {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

class Keys : public ::testing::Test {
protected:
    const base::TempDir dir{"key-test"};
    base::Diag diag{std::tmpfile()};

    [[nodiscard]] std::string in(const std::string& name) const { return dir.path() + "/" + name; }
    void write(const std::string& name, const std::string& text) const {
        fs::create_directories(fs::path(in(name)).parent_path());
        ASSERT_EQ(base::write_file_atomically(in(name), text), "");
    }
    std::string key(const ObjectOptions& options = {}) {
        const auto found = object_key(in("a.sl"), options, diag);
        EXPECT_TRUE(found);
        return found.value_or("");
    }
};

TEST_F(Keys, WhatIsIncludedIsPartOfThem) {
    write("a.sl", "#include \"b.h\"\nsurface a() { Ci = b; }\n");
    write("b.h", "#include \"deep/c.h\"\n");
    write("deep/c.h", "#define b 1\n");
    const std::string first = key();
    EXPECT_EQ(key(), first);
    write("deep/c.h", "#define b 2\n");
    EXPECT_NE(key(), first);
    write("deep/c.h", "#define b 1\n");
    EXPECT_EQ(key(), first) << "content counts, not time";
    ObjectOptions defined;
    defined.front.defines = {"X=1"};
    EXPECT_NE(key(defined), first);
}

TEST_F(Keys, AreTheSameInAnotherDirectory) {
    write("a.sl", "#include \"b.h\"\nsurface a() { Ci = b; }\n");
    write("b.h", "#define b 1\n");
    write("elsewhere/a.sl", *base::read_file(in("a.sl")));
    write("elsewhere/b.h", *base::read_file(in("b.h")));
    EXPECT_EQ(key(), object_key(in("elsewhere/a.sl"), {}, diag));
}

// Without the wait for clocks of coarse file systems (min_age 0).
TEST_F(Keys, TheIndexNoticesEveryChange) {
    write("a.sl", "#include \"b.h\"\n#include <c.h>\nsurface a() { Ci = 1; }\n");
    write("b.h", "// b\n");
    write("two/c.h", "// c\n");
    fs::create_directories(in("one"));
    ObjectOptions options;
    options.front.include_dirs = {in("one"), in("two")};
    const KeyIndex index(in("cache"), 0ms);
    const std::string request = base::sha256_hex("request");
    const auto remember = [&] {
        const auto text = preprocess_file(in("a.sl"), options.front, diag);
        ASSERT_TRUE(text);
        const Inclusions made_from = inclusions(*text, in("a.sl"), options.front.include_dirs);
        EXPECT_TRUE(made_from.is_certain);
        index.store(request, "the key", made_from.files, made_from.missing);
        EXPECT_EQ(index.find(request), "the key");
    };
    EXPECT_EQ(index.find(request), std::nullopt);
    for (const char* changed : {"a.sl", "b.h", "two/c.h"}) {
        remember();
        write(changed, *base::read_file(in(changed)) + "\n");
        EXPECT_EQ(index.find(request), std::nullopt) << changed;
    }
    remember();
    write("one/c.h", "// comes before two/c.h now\n");
    EXPECT_EQ(index.find(request), std::nullopt);
    remember();
    fs::remove(in("b.h"));
    EXPECT_EQ(index.find(request), std::nullopt);
}

TEST_F(Keys, FreshFilesAreNotTrusted) {
    write("a.sl", "x");
    const KeyIndex careful(in("cache"), 1h);
    careful.store(base::sha256_hex("r"), "key", {in("a.sl")}, {});
    EXPECT_EQ(careful.find(base::sha256_hex("r")), std::nullopt);
}

TEST_F(Keys, DamagedEntriesAreNone) {
    write("a.sl", "x");
    const KeyIndex index(in("cache"), 0ms);
    const std::string request = base::sha256_hex("r");
    index.store(request, "key", {in("a.sl")}, {in("absent")});
    ASSERT_EQ(index.find(request), "key");
    for (const auto& entry : fs::recursive_directory_iterator(in("cache"))) {
        if (!entry.is_regular_file()) {
            continue;
        }
        const std::string good = *base::read_file(entry.path());
        for (std::size_t n = 0; n < good.size(); ++n) {
            ASSERT_EQ(base::write_file_atomically(entry.path(), good.substr(0, n)), "");
            EXPECT_EQ(index.find(request), std::nullopt) << n;
        }
    }
}

TEST_F(Keys, TextsThatDependOnMoreAreNotIndexed) {
    for (const char* line : {"#if __has_include(\"x.h\")\n#endif\n", "string now = __DATE__;\n"}) {
        write("b.h", line);
        const std::string text = "# 1 \"" + in("a.sl") + "\"\n# 1 \"" + in("b.h") + "\" 1\n";
        write("a.sl", "#include \"b.h\"\n");
        EXPECT_FALSE(inclusions(text, in("a.sl"), {}).is_certain) << line;
    }
}

TEST(KeyText, DirectoriesAreTakenOut) {
    EXPECT_EQ(
        without_directories("# 1 \"/a/b/c.sl\"\nx # 1 \"/a/b\"\n# 7 \"d.h\" 1\n#line \"/q/r\"\n"),
        "# 1 \"c.sl\"\nx # 1 \"/a/b\"\n# 7 \"d.h\" 1\n#line \"/q/r\"\n");
}

} // namespace
} // namespace slc
