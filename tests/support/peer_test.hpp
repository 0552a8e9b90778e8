// Runs others' programs (tests/peer), where node and their packages are installed.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "support/folder.hpp"

namespace palpate::test {

class PeerTest : public testing::Test {
 protected:
  /// `package` is what npm calls it. Without it the tests are skipped.
  explicit PeerTest(const char* package) : package_(package) {}

  void SetUp() override {
    if (std::system("node --version >/dev/null 2>&1") != 0) {
      GTEST_SKIP() << "node is absent (Debian: nodejs)";
    }
    if (!std::filesystem::exists(std::filesystem::path(PALPATE_PEER) / "node_modules" / package_)) {
      GTEST_SKIP() << "tests/peer/node_modules lacks " << package_ << ": run npm ci in tests/peer";
    }
  }

  /// Runs a program of tests/peer. @return what it printed.
  [[nodiscard]] std::string run(const std::string& program, const std::string& arguments) const {
    const std::string command = fmt::format("cd {} && node {} {} >{} 2>{}", PALPATE_PEER, program,
                                            arguments, folder_ / "out", folder_ / "err");
    EXPECT_EQ(std::system(command.c_str()), 0) << folder_.read("err");
    return folder_.read("out");
  }

  Folder folder_;

 private:
  const char* package_;
};

}  // namespace palpate::test
