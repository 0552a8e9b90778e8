// What messages tell people to do is done to the input that earned them, which is then read right.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <regex>
#include <string>
#include <vector>

#include "io/reading.hpp"
#include "support/folder.hpp"

namespace palpate {
namespace {

// The part of a refusal that a pattern holds in brackets.
std::string told(const std::string& refused, const std::string& pattern) {
  std::smatch match;
  EXPECT_TRUE(std::regex_search(refused, match, std::regex(pattern))) << refused;
  return match.size() > 1 ? match[1].str() : "";
}

std::string replaced(std::string text, const std::string& pattern, const std::string& by) {
  return std::regex_replace(text, std::regex(pattern), by, std::regex_constants::format_first_only);
}

void expect_points(const std::string& bytes, const std::string& name, std::size_t count) {
  const CloudFile file = read_text(bytes, name);
  ASSERT_EQ(file.cloud.size(), count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto n = static_cast<double>(i);
    EXPECT_LT((file.cloud.point(i) - Eigen::Vector3d(n, 2 * n, 0.5)).norm(), 1e-6) << i;
  }
}

std::string rows(int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += fmt::format("{} {} 0.5\n", i, 2 * i);
  return text;
}

TEST(Remedies, OfFilesThatAreCut) {
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 9\nproperty float x\nproperty float y\n"
      "property float z\nend_header\n" +
      rows(5);
  const std::string element = told(refusal(ply), "write \"(element vertex 5)\"");
  expect_points(replaced(ply, "element vertex 9", element), "a.ply", 5);

  const std::string pcd =
      "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 3\nHEIGHT 3\nPOINTS 9\nDATA ascii\n" + rows(5);
  std::string mended = pcd;
  for (const std::string word : {"WIDTH", "HEIGHT", "POINTS"}) {
    mended = replaced(mended, word + " [0-9]+", told(refusal(pcd), "(" + word + " [0-9]+)"));
  }
  expect_points(mended, "a.pcd", 5);
}

TEST(Remedies, OfScansWithOtherNumbersOfPoints) {
  for (const char* count : {"9\n", "3\n"}) {
    const std::string pts = count + rows(5);
    expect_points(told(refusal(pts), "write ([0-9]+) here") + pts.substr(1), "a.pts", 5);
  }
}

TEST(Remedies, OfNumbersThatPandasPutsAboveColumns) {
  std::string text = ",0,1,2\n";
  for (int i = 0; i < 5; ++i) text += fmt::format("{},{},{},0.5\n", i, i, 2 * i);
  EXPECT_NE(refusal(text).find("a header line that names the columns x, y, z"), std::string::npos);
  expect_points("index,x,y,z" + text.substr(6), "a.csv", 5);
}

class PythonsRemedies : public testing::Test {
 protected:
  void SetUp() override {
    if (!runs("python3 -c 'import numpy' 2> /dev/null")) GTEST_SKIP() << "NumPy is not installed";
  }

  [[nodiscard]] bool runs(const std::string& command) const {
    const std::string in =
        fmt::format("export PATH=/usr/bin:$PATH; cd {}; ", folder_.path().string());
    return std::system((in + command).c_str()) == 0;
  }

  /// Does what the refusal of what is in the file tells.
  void obey(const std::string& name, const std::string& columns = "") {
    std::string command = told(refusal(folder_.read(name), name), "(python3 -c \"[^\"]*\")");
    if (!columns.empty()) command = replaced(command, "N\\)", columns + ")");
    ASSERT_TRUE(runs(command)) << command;
  }

  /// Makes `name` by Python's words, has it refused, does as is told and reads what comes out.
  void mend(const std::string& name, const std::string& words, const std::string& columns = "") {
    SCOPED_TRACE(words);
    const std::string make =
        "import numpy as np; i = np.arange(5.); p = np.stack([i, 2 * i, i * 0 + .5], -1); " + words;
    ASSERT_TRUE(runs("python3 -c \"" + make + '"'));
    obey(name, columns);
    expect_points(folder_.read("OUT.npy"), "OUT.npy", 5);
  }

  test::Folder folder_;
};

TEST_F(PythonsRemedies, OfArrays) {
  for (const std::string made :
       {"p.astype('f2')", "p.astype('>f8')", "p.reshape(-1)", "p.reshape(1, 5, 3)",
        "np.array([tuple(q) for q in p], [('x', 'f4'), ('y', 'f4'), ('z', 'f8')])"}) {
    mend("IN.npy", "np.save('IN.npy', " + made + ")");
  }
}

TEST_F(PythonsRemedies, OfFloatsInOtherGroups) {
  mend("IN.bin", "np.hstack([p, -1 - p[:, :2]]).astype('f4').tofile('IN.bin')", "5");
}

TEST_F(PythonsRemedies, OfPicturesOfFloats) {
  std::string bytes = "Pf\n3 2\n-1.0\n";
  for (const float depth : {0.5F, 1.F, INFINITY, 2.F, 3.F, NAN}) append(bytes, depth);
  folder_.write("IN.pfm", bytes);
  obey("IN.pfm");
  const DepthFrame frame =
      read_depth_frame(folder_ / "OUT.pgm", {.camera = {0, 0, {9, 9, 1, 1}, {}}});
  EXPECT_EQ(frame.camera.width, 3);
  EXPECT_EQ(frame.depth, (std::vector<float>{2, 3, 0, 0.5F, 1, 0})) << "the lowest row came first";
}

}  // namespace
}  // namespace palpate
