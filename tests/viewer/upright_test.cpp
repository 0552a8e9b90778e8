#include "viewer/upright.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <numbers>

#include "base/numbers.hpp"
#include "palpate/io/files.hpp"
#include "support/effort.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

Vector3d up_of(const PointCloud& cloud) {
  Scene scene;
  scene.add("cloud", cloud);
  return likely_up(scene);
}

// A dome 0.2 m wide and 0.3 m high, with what it stands on; `up` is its own z.
PointCloud dome(const Vector3f& up, std::uint64_t seed) {
  Random random(seed);
  const Eigen::Quaternionf turn = Eigen::Quaternionf::FromTwoVectors(Vector3f::UnitZ(), up);
  PointCloud cloud;
  for (int i = 0; i < 6000; ++i) {
    const double angle = 2 * std::numbers::pi * random.uniform();
    const bool foot = i % 4 == 0;
    const double height = foot ? 0 : random.uniform();
    const double r = foot ? std::sqrt(random.uniform()) : std::sqrt(1 - height * height);
    const Vector3d place(0.1 * r * std::cos(angle), 0.1 * r * std::sin(angle), 0.3 * height);
    cloud.positions.push_back(turn * place.cast<float>() + Vector3f(3, 4, 5));
  }
  return cloud;
}

TEST(LikelyUp, IsWhereAThingStandsOnItsFoot) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    for (const Vector3f& up :
         {Vector3f::UnitZ().eval(), Vector3f::UnitY().eval(), (-Vector3f::UnitY()).eval()}) {
      EXPECT_EQ(up_of(dome(up, seed)), up.cast<double>()) << "seed " << seed;
    }
  }
}

TEST(LikelyUp, IsZWhereNothingElseIsLikely) {
  EXPECT_EQ(likely_up(Scene()), Vector3d::UnitZ());
  EXPECT_EQ(up_of(dome(Vector3f::UnitX(), 4)), Vector3d::UnitZ()) << "nobody's x is up";
  Random random(5);
  PointCloud ball;
  PointCloud wall;
  for (int i = 0; i < 5000; ++i) {
    const Vector3f place(random.normal(), random.normal(), random.normal());
    ball.positions.push_back(place.normalized());
    const auto uniform = [&] { return static_cast<float>(random.uniform()); };
    wall.positions.emplace_back(4 * uniform(), i % 9 == 0 ? 0.2F * uniform() : 0, 3 * uniform());
  }
  EXPECT_EQ(up_of(ball), Vector3d::UnitZ());
  EXPECT_EQ(up_of(wall), Vector3d::UnitZ());
  PointCloud facade;  // with the ground before it
  for (int i = 0; i < 5000; ++i) {
    const auto uniform = [&] { return static_cast<float>(random.uniform()); };
    const bool ground = i % 5 == 0;
    facade.positions.emplace_back(20 * uniform(), ground ? 10 * uniform() : 10,
                                  ground ? 0 : 8 * uniform());
  }
  EXPECT_EQ(up_of(facade), Vector3d::UnitZ());
  for (const int walls : {2, 3}) {  // at eye level: of a room without floor and ceiling
    PointCloud room;
    for (int i = 0; i < 6000; ++i) {
      const auto along = static_cast<float>(random.uniform());
      const int which = i % walls;
      room.positions.emplace_back(which == 0 ? 6 * along : 0, which == 0 ? 0 : 4 * along,
                                  2.5F * static_cast<float>(random.uniform()));
      if (which == 2) room.positions.back().x() = 6;
    }
    EXPECT_EQ(up_of(room), Vector3d::UnitZ()) << walls;
  }
}

TEST(LikelyUp, IsTrueOfRealScans) {
  if (test::is_slow_build()) GTEST_SKIP() << test::kSlowBuild;
  const char* data = std::getenv("PALPATE_DATA");
  if (data == nullptr) GTEST_SKIP() << "PALPATE_DATA does not name a folder of real data";
  const std::filesystem::path folder = data;
  for (const auto& [name, up] : std::map<const char*, Vector3d>{
           {"stanford_bunny/bun_zipper_res3.ply", Vector3d::UnitY()},
           {"stanford_dragon/dragon_vrip_res3.ply.gz", Vector3d::UnitY()},
           {"lamppost/lamppost.pcd", Vector3d::UnitZ()},
           {"pdal_small/autzen_trim.las", Vector3d::UnitZ()}}) {
    EXPECT_EQ(up_of(read_cloud(folder / name)), up) << name;
  }
}

}  // namespace
}  // namespace palpate
