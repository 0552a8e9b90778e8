// Another reader, web-e57 (npm), finds the same points in the files that the tests write.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>
#include <sstream>

#include "io/e57_bytes.hpp"
#include "support/peer_test.hpp"

namespace palpate {
namespace {

struct PeerPoint {
  Eigen::Vector3d position;
  std::array<int, 3> color{};
};

class E57Peer : public test::PeerTest {
 protected:
  E57Peer() : PeerTest("web-e57") {}

  [[nodiscard]] std::vector<PeerPoint> read(const std::string& bytes) const {
    folder_.write("a.e57", bytes);
    std::vector<PeerPoint> points;
    std::istringstream lines(run("e57.mjs", folder_ / "a.e57"));
    for (std::string line; std::getline(lines, line);) {
      std::istringstream row(line);
      PeerPoint& point = points.emplace_back();
      row >> point.position.x() >> point.position.y() >> point.position.z();
      row >> point.color[0] >> point.color[1] >> point.color[2];
    }
    return points;
  }

  // Both readers' points are `expected`, ours as far as floats go.
  void expect_both(const std::vector<E57TestScan>& scans,
                   const std::vector<Eigen::Vector3d>& expected) const {
    const std::string bytes = E57TestFile(scans).bytes();
    const std::vector<PeerPoint> theirs = read(bytes);
    const CloudFile ours = read_text(bytes, "a.e57");
    ASSERT_EQ(theirs.size(), expected.size());
    ASSERT_EQ(ours.cloud.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      ASSERT_LT((theirs[i].position - expected[i]).norm(), 1e-12 * (1 + expected[i].norm())) << i;
      ASSERT_LT((ours.cloud.point(i) - expected[i]).norm(), 1e-6) << i;
      if (ours.cloud.colors.empty()) continue;
      for (std::size_t k = 0; k < 3; ++k) ASSERT_EQ(theirs[i].color[k], ours.cloud.colors[i][k]);
    }
  }
};

constexpr std::size_t kCount = 3000;

// Evenly spread numbers of the width, and what they stand for.
std::vector<std::int64_t> numbers(std::int64_t least, std::int64_t most, std::uint32_t seed) {
  std::mt19937_64 random(seed);
  std::vector<std::int64_t> values(kCount);
  const auto range = static_cast<std::uint64_t>(most - least) + 1;
  for (auto& value : values) value = least + static_cast<std::int64_t>(random() % range);
  return values;
}

TEST_F(E57Peer, ReadsTheSameScaledIntegersFloatsColoursAndPose) {
  const auto x = numbers(-3000, 70'000, 1);
  const auto y = numbers(-1'000'000, 1'000'000, 2);
  const auto z = numbers(0, 1'000'000'000, 3);
  const auto red = numbers(0, 255, 4);
  std::vector<double> singles;
  std::vector<double> doubles;
  for (std::size_t i = 0; i < kCount; ++i) {
    singles.push_back(static_cast<double>(static_cast<float>(y[i]) * 1e-6F));
    doubles.push_back(static_cast<double>(z[i]) * 1e-9);
  }
  const Eigen::Quaterniond turn = Eigen::Quaterniond(0.1, 0.7, -0.3, 0.5).normalized();
  E57TestScan scan{
      {e57_scaled("cartesianX", -3000, 70'000, 1e-4, 0.25, x), e57_singles("cartesianY", singles),
       e57_doubles("cartesianZ", doubles), e57_integers("colorRed", 0, 255, red),
       e57_integers("colorGreen", 0, 255, numbers(0, 255, 5)),
       e57_integers("colorBlue", 0, 255, numbers(0, 255, 6))},
      e57_pose({turn.w(), turn.x(), turn.y(), turn.z()}, {1.5, -2.5, 0.125})};
  scan.simple = true;
  std::vector<Eigen::Vector3d> expected;
  for (std::size_t i = 0; i < kCount; ++i) {
    const Eigen::Vector3d point(static_cast<double>(x[i]) * 1e-4 + 0.25, singles[i], doubles[i]);
    expected.push_back(turn * point + Eigen::Vector3d(1.5, -2.5, 0.125));
  }
  expect_both({scan}, expected);
}

TEST_F(E57Peer, ReadsTheSameRangesAndAngles) {
  std::vector<double> range;
  std::vector<double> azimuth;
  std::vector<double> elevation;
  std::vector<Eigen::Vector3d> expected;
  for (std::size_t i = 0; i < kCount; ++i) {
    const auto t = static_cast<double>(i);
    range.push_back(1 + t / 1000);
    azimuth.push_back(-3 + t / 500);
    elevation.push_back(1.5 - t / 1000);
    expected.emplace_back(range[i] * std::cos(elevation[i]) * std::cos(azimuth[i]),
                          range[i] * std::cos(elevation[i]) * std::sin(azimuth[i]),
                          range[i] * std::sin(elevation[i]));
  }
  E57TestScan scan{{e57_doubles("sphericalRange", range), e57_doubles("sphericalAzimuth", azimuth),
                    e57_doubles("sphericalElevation", elevation)}};
  scan.simple = true;
  expect_both({scan}, expected);
}

TEST_F(E57Peer, ReadsTheSameIntegersOfManyWidths) {
  std::vector<E57TestScan> scans;
  std::vector<Eigen::Vector3d> expected;
  for (unsigned bits = 1; bits <= 40; ++bits) {
    const std::int64_t most = (std::int64_t{1} << bits) - 1;
    const double scale = 1 / static_cast<double>(most);
    const std::size_t before = expected.size();
    expected.resize(before + kCount);
    E57TestScan& scan = scans.emplace_back();
    scan.simple = true;
    for (unsigned k = 0; k < 3; ++k) {
      const auto values = numbers(0, most, k + bits);
      const std::string name = std::string("cartesian") + "XYZ"[k];
      scan.fields.push_back(e57_scaled(name, 0, most, scale, 0, values));
      for (std::size_t i = 0; i < kCount; ++i) {
        expected[before + i][k] = static_cast<double>(values[i]) * scale;
      }
    }
  }
  expect_both(scans, expected);
}

}  // namespace
}  // namespace palpate
