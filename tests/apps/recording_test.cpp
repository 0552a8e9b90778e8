#include <gtest/gtest.h>

#include <filesystem>

#include "apps/palpate/report/log.hpp"
#include "apps/program.hpp"
#include "support/folder.hpp"

namespace palpate::app {
namespace {

namespace fs = std::filesystem;

// Recordings go to the folder that the program was started in.
class RecordingTest : public testing::Test {
 protected:
  RecordingTest() { fs::current_path(folder_.path()); }
  ~RecordingTest() override { fs::current_path(before_); }

  [[nodiscard]] std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_.path())) {
      names.push_back(entry.path().filename());
    }
    return names;
  }

  fs::path before_ = fs::current_path();
  test::Folder folder_;
};

void ignore(const std::string&) {}

TEST_F(RecordingTest, WhatWasBegunIsKeptWhenTheRunEnds) {
  std::string name;
  {
    Recording recording(2, ignore);
    recording.add(0, {}, {});  // nothing is recorded yet
    name = recording.record(true);
    recording.add(0, {}, {});
    recording.add(1, {}, {});
    recording.add(1, {}, {});
  }
  ASSERT_EQ(files().size(), 2u) << "a file a hand";
  EXPECT_TRUE(fs::exists(name));
}

TEST_F(RecordingTest, ToBeginTwiceIsToGoOn) {
  Recording recording(1, ignore);
  const std::string name = recording.record(true);
  recording.add(0, {}, {});
  EXPECT_EQ(recording.record(true), name);
  recording.add(0, {}, {});
  EXPECT_EQ(recording.record(false), name);
  EXPECT_EQ(recording.record(false), "") << "nothing goes on any more";
  ASSERT_EQ(files(), std::vector{name});
  EXPECT_GT(fs::file_size(name), 200u);
}

TEST_F(RecordingTest, WhatCannotBeMadeChangesNothing) {
  Recording recording(1, ignore);
  fs::current_path("/proc");
  EXPECT_ANY_THROW(recording.record(true));
  recording.add(0, {}, {});
  fs::current_path(folder_.path());
  EXPECT_FALSE(recording.record(true).empty()) << "it may be begun again";
}

}  // namespace
}  // namespace palpate::app
