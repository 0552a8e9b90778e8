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

TEST(Remedies, OfScansOfPtxThatAreCut) {
  const std::string head = "3\n3\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";
  std::string points;
  for (int i = 0; i < 5; ++i) points += fmt::format("{} {} 0.5 1\n", i, 2 * i);
  for (const std::string cut : {"", "7 8"}) {
    const std::string refused = refusal(head + points + cut, "a.ptx");
    EXPECT_EQ(refused.find("remove its last line") == std::string::npos, cut.empty()) << refused;
    const std::string count = told(refused, "write 1 here and ([0-9]+) in the next line");
    const CloudFile file = read_text("1\n" + count + head.substr(3) + points, "a.ptx");
    EXPECT_EQ(file.cloud.size() + file.dropped, 5u);
  }
}

TEST(Remedies, OfMeshesOfTextThatAreCut) {
  const std::string face =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
      "vertex 0 1 0\nendloop\nendfacet\n";
  const std::string cut = "solid a\n" + face;
  const std::string line = told(refusal(cut, "a.stl"), "write (endsolid) below them");
  EXPECT_EQ(read_text(cut + line + "\n", "a.stl").mesh->triangles, 1u);
}

TEST(Remedies, OfNumbersThatPandasPutsAboveColumns) {
  std::string text = ",0,1,2\n";
  for (int i = 0; i < 5; ++i) text += fmt::format("{},{},{},0.5\n", i, i, 2 * i);
  EXPECT_NE(refusal(text).find("a header line that names the columns x, y, z"), std::string::npos);
  expect_points("index,x,y,z" + text.substr(6), "a.csv", 5);
}

class CommandRemedies : public testing::Test {
 protected:
  [[nodiscard]] bool runs(const std::string& command) const {
    const std::string in =
        fmt::format("export PATH=/usr/bin:$PATH; cd {}; ", folder_.path().string());
    return std::system((in + command).c_str()) == 0;
  }

  test::Folder folder_;
};

TEST_F(CommandRemedies, OfFilesThatAreCompressed) {
  struct Packed {
    std::string by;
    std::string name;
    std::string command;  // in the message
  };
  for (const Packed& each :
       {Packed{"xz a.xyz", "a.xyz.xz", "\"(xz -dk FILE)\""},
        Packed{"zstd -q --rm a.xyz -o a.xyz.zst", "a.xyz.zst", "(zstd -d FILE)"},
        Packed{"bzip2 a.xyz", "a.xyz.bz2", "(bunzip2 -k FILE)"},
        Packed{"python3 -m zipfile -c a.zip a.xyz && rm a.xyz", "a.zip", "(unzip FILE)"}}) {
    folder_.write("a.xyz", rows(5));
    if (!runs(each.by + " 2> /dev/null")) continue;  // the program is not installed
    const std::string told_to = told(refusal(folder_.read(each.name), each.name), each.command);
    const std::string command = replaced(told_to, "FILE", each.name);
    if (!runs("which " + command.substr(0, command.find(' ')) + " > /dev/null")) continue;
    ASSERT_TRUE(runs(command + " > /dev/null 2>&1")) << command;
    expect_points(folder_.read("a.xyz"), "a.xyz", 5);
  }
}

class PythonsRemedies : public CommandRemedies {
 protected:
  void SetUp() override {
    if (!runs("python3 -c 'import numpy' 2> /dev/null")) GTEST_SKIP() << "NumPy is not installed";
  }

  /// Does what the refusal of what is in the file tells.
  void obey(const std::string& name) {
    const std::string command = told(refusal(folder_.read(name), name), "(python3 -c \"[^\"]*\")");
    ASSERT_TRUE(runs(command)) << command;
  }

  /// Makes `name` by Python's words, has it refused, does as is told and reads what comes out.
  void mend(const std::string& name, const std::string& words) {
    SCOPED_TRACE(words);
    const std::string make =
        "import numpy as np; i = np.arange(5.); p = np.stack([i, 2 * i, i * 0 + .5], -1); " + words;
    ASSERT_TRUE(runs("python3 -c \"" + make + '"'));
    obey(name);
    expect_points(folder_.read("OUT.npy"), "OUT.npy", 5);
  }
};

TEST_F(PythonsRemedies, OfArrays) {
  for (const std::string made :
       {"p.astype('f2')", "p.astype('>f8')", "p.reshape(-1)",
        "np.array([tuple(q) for q in p], [('x', 'f4'), ('y', 'f4'), ('z', 'f8')])",
        "np.array([tuple(q) for q in p], [('f0', '>f4'), ('f1', 'f4'), ('f2', 'f4')])",
        "np.array([(7, *q) for q in p], [('id', 'i4'), ('X', 'f4'), ('Y', 'f4'), ('Z', 'f4')])",
        "np.array([('a', *q[::-1]) for q in p], [('n', 'U4'), ('z', 'f4'), ('y', 'f4'), ('x', "
        "'f4')])",
        "np.array([(q, 1) for q in p], [('xyz', 'f4', 3), ('i', 'u1')])",
        "np.array([[tuple(q)] for q in p], [('x', 'f4'), ('y', 'f4'), ('z', 'f8')])"}) {
    mend("IN.npy", "np.save('IN.npy', " + made + ")");
  }
}

TEST_F(PythonsRemedies, OfDepthsInArrays) {
  for (const std::string made :
       {"np.full((20, 40), .5)", "np.full((80, 60), 500, 'u2')", "np.full((1, 20, 40), .5, 'f2')",
        "np.full((7, 20, 40), .5, 'f4')"}) {
    SCOPED_TRACE(made);
    ASSERT_TRUE(runs("python3 -c \"import numpy as np; np.save('IN.npy', " + made + ")\""));
    obey("IN.npy");
    const DepthFrame frame =
        read_depth_frame(folder_ / "OUT.pgm", {.camera = {0, 0, {9, 9, 1, 1}, {}}});
    EXPECT_EQ(frame.depth, std::vector<float>(frame.depth.size(), 0.5F));
    EXPECT_NE(frame.camera.width, frame.camera.height);
  }
}

TEST_F(PythonsRemedies, OfArchivesOfArrays) {
  for (const std::string made : {"np.savez('IN.npz', colors=p[:, :2], points=p)",
                                 "np.savez_compressed('IN.npz', n=np.arange(99), p=p)"}) {
    mend("IN.npz", made);
  }
}

TEST_F(PythonsRemedies, OfFloatsInOtherGroups) {
  mend("IN.bin", "np.hstack([p, -1 - p[:, :2]]).astype('f4').tofile('IN.bin')");
  mend("IN.bin", "np.hstack([p, -9 + 0 * p[:, :1]]).tofile('IN.bin')");
  mend("IN.bin", "p.astype('f4').tofile('IN.bin')");
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
