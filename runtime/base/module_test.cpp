// SPDX-License-Identifier: Apache-2.0
// What a missing module says; modules that exist are opened by the tests of their users.
#include "runtime/base/module.h"

#include <filesystem>
#include <gtest/gtest.h>

namespace {

TEST(Module, ProgramDirectoryHoldsThisTest) {
    EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(base::program_directory()) /
                                        "base_module_test"));
}

TEST(Module, MissingOneIsAnError) {
    const base::ModuleSymbol found = base::open_module("perigee_no_such_part", "start");
    EXPECT_EQ(found.address, nullptr);
    EXPECT_NE(found.error.find("perigee_no_such_part.so"), std::string::npos) << found.error;
}

} // namespace
