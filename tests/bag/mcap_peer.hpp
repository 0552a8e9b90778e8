#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "bag/bags.hpp"
#include "support/folder.hpp"

namespace palpate::bag {

/// Runs others' programs for bags (tests/peer), where node and they are installed.
class McapPeer : public testing::Test {
 protected:
  void SetUp() override {
    if (std::system("node --version >/dev/null 2>&1") != 0) {
      GTEST_SKIP() << "node is absent (Debian: nodejs)";
    }
    if (!std::filesystem::exists(std::filesystem::path(PALPATE_PEER) /
                                 "node_modules/.package-lock.json")) {
      GTEST_SKIP() << "tests/peer/node_modules is absent: run npm ci in tests/peer";
    }
  }

  // Runs a program of the peer's; what it printed.
  [[nodiscard]] std::string run(const std::string& program, const std::string& arguments) const {
    const std::string command = fmt::format("cd {} && node {} {} >{} 2>{}", PALPATE_PEER, program,
                                            arguments, folder_ / "out", folder_ / "err");
    EXPECT_EQ(std::system(command.c_str()), 0) << contents_of(folder_ / "err");
    return contents_of(folder_ / "out");
  }

  test::Folder folder_;
};

}  // namespace palpate::bag
