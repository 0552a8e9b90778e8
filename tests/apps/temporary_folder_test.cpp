#include "apps/palpate/cli/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "palpate/base/error.hpp"

namespace palpate::app {
namespace {

namespace fs = std::filesystem;

std::string contents_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(TemporaryFolder, ALentFileIsReadByItsPathButHasNoBytesInTheFolder) {
  TemporaryFolder folder;
  const std::string path = folder.lend("cloud.xyz", "1 2 3\n");
  EXPECT_EQ(fs::path(path).filename(), "cloud.xyz");
  for (int i = 0; i < 2; ++i) EXPECT_EQ(contents_of(path), "1 2 3\n");
  EXPECT_EQ(fs::file_size(path), 6U);
  // What a killed program would leave is a link to nothing.
  EXPECT_TRUE(fs::is_symlink(path));
  EXPECT_EQ(fs::hard_link_count(path), 0U);
}

TEST(TemporaryFolder, WhatCannotBeWrittenLeadsToTMPDIR) {
  const TemporaryFolder folder;
  try {
    (void)folder.write("absent/cloud.xyz", "1 2 3\n");
    FAIL() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("set TMPDIR"), std::string::npos) << error.what();
  }
}

TEST(TemporaryFolder, VanishesWithWhatIsInIt) {
  std::string lent;
  std::string written;
  {
    TemporaryFolder folder;
    lent = folder.lend("a", "a");
    written = folder.write("b", "b");
    EXPECT_EQ(contents_of(written), "b");
  }
  EXPECT_FALSE(fs::exists(fs::path(lent).parent_path()));
}

}  // namespace
}  // namespace palpate::app
