#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <limits>
#include <stdexcept>
#include <thread>

#include "io/reading.hpp"
#include "palpate/io/files.hpp"

namespace palpate {
namespace {

using testing::HasSubstr;

class ReadCloud : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("palpate-io-" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }

  static std::string refusal_of(const std::filesystem::path& path) {
    try {
      (void)read_cloud(path);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }

  std::filesystem::path folder_;
};

TEST_F(ReadCloud, ReadsAFile) {
  EXPECT_EQ(read_cloud(write("a.xyz", "1 2 3\n")).point(0), Eigen::Vector3d(1, 2, 3));
}

TEST_F(ReadCloud, SaysWhyAPathCannotBeRead) {
  EXPECT_THAT(refusal_of(folder_ / "absent.ply"), HasSubstr("absent.ply: no such file"));
  EXPECT_THAT(refusal_of(folder_), HasSubstr("is a folder"));
  EXPECT_THAT(refusal_of("/dev/zero"), HasSubstr("is a device"));
  EXPECT_THAT(refusal_of(write("empty.ply", "")), HasSubstr("empty.ply: the file is empty"));
  EXPECT_THAT(refusal_of(write("a", "1 2 3\n") / "b"), HasSubstr("cannot be opened"));
  EXPECT_THAT(refusal_of(folder_ / std::string(300, 'a')), HasSubstr("cannot be opened"));
}

TEST_F(ReadCloud, SaysWhatAFolderHolds) {
  EXPECT_THAT(refusal_of(folder_), HasSubstr("Give a file, or a folder that holds"));
  write("b.ply", "");
  write("a.PLY", "");
  EXPECT_THAT(refusal_of(folder_), HasSubstr("such as " + (folder_ / "a.PLY").string()));
  write("run.mcap", "");
  EXPECT_THAT(refusal_of(folder_), HasSubstr("bag:" + folder_.string()));
  write("sequence.json", "{}");
  EXPECT_THAT(refusal_of(folder_), HasSubstr("sequence:" + folder_.string()));
}

TEST_F(ReadCloud, SaysWhenPermissionIsMissing) {
  if (geteuid() == 0) GTEST_SKIP() << "root may read everything";
  const auto path = write("secret.xyz", "1 2 3\n");
  std::filesystem::permissions(path, std::filesystem::perms::none);
  EXPECT_THAT(refusal_of(path), HasSubstr("no permission"));
}

TEST_F(ReadCloud, ReadsAPipe) {
  const auto path = folder_ / "pipe";
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  std::string text;
  for (int i = 0; i < 300000; ++i) text += "1 2 3\n";  // more than a block
  std::jthread writer([&] { std::ofstream(path) << text; });
  EXPECT_EQ(read_cloud(path).size(), 300000u);
}

TEST_F(ReadCloud, MultipliesByTheScaleInDoublePrecision) {
  const CloudFile file = read_text("4000000000.25 0 0\n4000000001.5 0 0\n", "a", {.scale = 1e-3});
  EXPECT_NEAR(file.cloud.point(1).x() - file.cloud.point(0).x(), 0.00125, 1e-9);
  for (const double scale : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THAT(refusal("1 2 3\n", "a", {.scale = scale}), HasSubstr("Give a scale above zero"));
  }
}

TEST_F(ReadCloud, ReportsProgressUpToOne) {
  std::string text;
  for (int i = 0; i < 10000; ++i) text += "1 2 3\n";
  std::vector<double> reports;
  (void)read_text(text, "a", {.progress = [&](double part) { reports.push_back(part); }});
  EXPECT_GT(reports.size(), 50u);
  EXPECT_LT(reports.size(), 200u);
  EXPECT_TRUE(std::is_sorted(reports.begin(), reports.end()));
  EXPECT_EQ(reports.back(), 1.0);
  const auto stop = [](double) { throw std::runtime_error("stop"); };
  EXPECT_THROW((void)read_text(text, "a", {.progress = stop}), std::runtime_error);
}

TEST_F(ReadCloud, MessagesShowNothingThatATerminalObeys) {
  const std::string message = refusal("1 2 3\n1 \x1b[2J 3\n");
  EXPECT_EQ(message.find('\x1b'), std::string::npos);
}

}  // namespace
}  // namespace palpate
