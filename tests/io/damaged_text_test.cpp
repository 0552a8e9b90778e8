// Cuts and flipped bits in scans, arrays and tables that other programs write: each is read or
// refused with words, and one that declares how much it holds is refused where it was cut.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "io/reading.hpp"
#include "palpate/io/trajectory.hpp"
#include "support/effort.hpp"

namespace palpate {
namespace {

std::string ptx_rows() {
  std::string text;
  for (int i = 0; i < 12; ++i) {
    text += i % 5 == 4 ? "0 0 0 0\n" : fmt::format("{} {} 0.5 1 9 99 255\n", i, 2 * i);
  }
  return text;
}

const std::string kHead = "3\n4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n";

// A scan whose matrix is by columns.
std::string made_ptx() {
  return kHead + "1 0 0 7\n0 1 0 0\n0 0 1 0\n0 0 0 1\n" + ptx_rows();
}

std::string made_points3d() {
  std::string text =
      "#   POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[] as (IMAGE_ID, POINT2D_IDX)\n";
  for (int i = 0; i < 20; ++i) {
    text += fmt::format("{} {} {} 0.5 9 99 255 0.1 1 {}", 97 * i % 41, i, 2 * i, i);
    text += i % 3 == 0 ? " 2 7\n" : "\n";
  }
  return text;
}

// What states a unit, before rows of points.
std::string made_table(const std::string& head) {
  std::string text = head;
  for (int i = 0; i < 20; ++i) text += fmt::format("{},{},{}\n", i, 2 * i, 0.5 * i);
  return text;
}

std::string made_npy(const std::string& type, const std::string& shape) {
  std::string header =
      fmt::format("{{'descr': {}, 'fortran_order': False, 'shape': {}, }}\n", type, shape);
  std::string bytes("\x93NUMPY\x01\0", 8);
  append(bytes, static_cast<std::uint16_t>(header.size()));
  bytes += header;
  for (int i = 0; i < 60; ++i) append(bytes, 0.25F * static_cast<float>(i));
  return bytes;
}

std::string damaged(const std::string& whole, int i, std::mt19937& random) {
  std::string bytes = whole;
  const std::size_t at = random() % bytes.size();
  if (i % 2 == 1) return bytes.substr(0, at);
  bytes[at] = static_cast<char>(bytes[at] ^ (1 << (random() % 8)));
  return bytes;
}

struct Case {
  std::string name;
  std::string bytes;
  bool declares = false;  // how much it holds
};

TEST(DamagedText, IsReadOrRefused) {
  std::mt19937 random(78);  // NOLINT(cert-msc32-c,cert-msc51-cpp): the same in every run
  for (const Case& each :
       {Case{"a.ptx", made_ptx(), true}, Case{"points3D.txt", made_points3d()},
        Case{"a.csv", made_table("# Units: US survey feet\nX [ft],Y [ft],Z (NAVD88 ft)\n")},
        Case{"a.obj", "# 1 unit = 25.4 mm\nv 0 0 0\nv 9 0 0\nv 0 9 0\nv 0 0 9\nf 1 2 3 4\n"},
        Case{"a.npy", made_npy("'<f4'", "(3, 4, 5)"), true},
        Case{"a.npy", made_npy("[('x', '<f4'), ('y', '<f4'), ('z', '<f4')]", "(20,)"), true},
        Case{"a.npy", made_npy("'<f4'", "(60,)"), true},
        Case{"a.bin", made_npy("'<f4'", "(60,)").substr(64)}}) {
    for (int i = 0; i < test::effort(2000); ++i) {
      const std::string bytes = damaged(each.bytes, i, random);
      try {
        const CloudFile file = read_text(bytes, each.name);
        // The last row may end sooner: its last digits, or the end of its line.
        const bool cut = i % 2 == 1 && bytes.size() + 4 < each.bytes.size();
        ASSERT_FALSE(cut && each.declares) << each.name << " cut to " << bytes.size();
        for (const Eigen::Vector3f& p : file.cloud.positions) ASSERT_TRUE(p.allFinite());
      } catch (const Error& error) {
        ASSERT_NE(std::string(error.what()).find(each.name), std::string::npos);
      }
    }
  }
}

TEST(DamagedText, OfTrajectoriesIsReadOrRefused) {
  std::string text =
      "t,hip_x,hip_y,hip_z,pose.orientation.x,pose.orientation.y,pose.orientation.z,"
      "pose.orientation.w,roll,pitch,yaw_deg\n";
  for (int i = 0; i < 20; ++i) text += fmt::format("{},1,2,3,0.6,0,0,0.8,1,1,1\n", 0.001 * i);
  std::mt19937 random(79);  // NOLINT(cert-msc32-c,cert-msc51-cpp): the same in every run
  for (int i = 0; i < test::effort(2000); ++i) {
    std::istringstream stream(damaged(text, i, random));
    try {
      for (const TrajectoryRow& row : read_trajectory(stream, "a.csv")) {
        ASSERT_NEAR(row.orientation.value_or(Eigen::Quaterniond::Identity()).norm(), 1, 0.11);
      }
    } catch (const Error& error) {
      ASSERT_NE(std::string(error.what()).find("a.csv"), std::string::npos);
    }
  }
}

// Arrays of any shape whose channels are an axis of 3: the same points, wherever that is.
TEST(DamagedText, NpyFindsAnAxisOfThreeWhereverItIs) {
  std::mt19937 random(80);  // NOLINT(cert-msc32-c,cert-msc51-cpp): the same in every run
  for (int i = 0; i < test::effort(100); ++i) {
    const auto size = [&] { return 10 + random() % 5; };
    const std::vector<std::size_t> sizes{size(), size(), 1 + random() % 2};
    const std::size_t axis = random() % (sizes.size() + 1);
    std::vector<std::size_t> shape = sizes;
    shape.insert(shape.begin() + static_cast<std::ptrdiff_t>(axis), 3);
    std::size_t inner = 1;
    for (std::size_t k = axis; k < sizes.size(); ++k) inner *= sizes[k];
    const std::size_t points = sizes[0] * sizes[1] * sizes[2];
    std::string header = "{'descr': '<f8', 'fortran_order': False, 'shape': (";
    for (const std::size_t each : shape) header += fmt::format("{}, ", each);
    header += "), }\n";
    std::string bytes("\x93NUMPY\x01\0", 8);
    append(bytes, static_cast<std::uint16_t>(header.size()));
    bytes += header;
    for (std::size_t k = 0; k < 3 * points; ++k) append(bytes, static_cast<double>(k));
    const CloudFile file = read_text(bytes, "a.npy");
    ASSERT_EQ(file.cloud.size(), points) << header;
    for (std::size_t k = 0; k < points; ++k) {
      const std::size_t first = k / inner * 3 * inner + k % inner;
      const Eigen::Vector3d expected(static_cast<double>(first), static_cast<double>(first + inner),
                                     static_cast<double>(first + 2 * inner));
      ASSERT_LT((file.cloud.point(k) - expected).norm(), 0.01) << header << k;
    }
  }
}

}  // namespace
}  // namespace palpate
