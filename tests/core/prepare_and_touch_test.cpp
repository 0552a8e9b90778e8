// The core on the whole of its way: a cloud is read, prepared, touched, and is where it should be.
// These tests pass with the core alone and with all floors beside it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <vector>

#include "palpate/contact/proxy.hpp"
#include "palpate/io/files.hpp"
#include "palpate/io/synthetic.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/scene/scene_field.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr double kTick = 1e-3;  // s
constexpr int kHands = 200;     // directions from which hands come
constexpr double kDeep = 1e-3;  // m that a hand goes under the surface

/// Directions that are spread evenly over a ball.
Vector3d direction(int i) {
  const double z = 1 - 2 * (i + 0.5) / kHands;
  const double turn = i * std::numbers::pi * (3 - std::sqrt(5.));
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(turn), r * std::sin(turn), z};
}

/// A cloud as the only one of a scene, and hands on it.
class Touched {
 public:
  explicit Touched(const PointCloud& cloud, const FieldOptions& options = {})
      : source_(scene_.add("cloud", cloud)), field_(scene_, options) {}

  /// Where a proxy comes to rest while its hand goes in a straight line.
  Vector3d rest(const Vector3d& from, const Vector3d& to) {
    constexpr int kSteps = 200;
    Proxy proxy;
    proxy.reset(from);
    for (int k = 1; k <= kSteps; ++k) {
      const Vector3d hand = from + (to - from) * k / kSteps;
      field_.update(k * kTick, hand, proxy);
      force_ = proxy.step(field_, hand, kTick).force;
    }
    return proxy.position();
  }

  [[nodiscard]] const Vector3d& force() const { return force_; }
  [[nodiscard]] double radius() const { return source_.points()->radius; }
  [[nodiscard]] const SurfacePoints& points() const { return *source_.points(); }

 private:
  Scene scene_;
  Source& source_;
  SceneField field_;
  Vector3d force_ = Vector3d::Zero();
};

double rms(const std::vector<double>& errors) {
  double squares = 0;
  for (const double error : errors) squares += error * error;
  return std::sqrt(squares / static_cast<double>(errors.size()));
}

PointCloud without_normals(PointCloud cloud) {
  cloud.normals.clear();
  return cloud;
}

TEST(PrepareAndTouch, ASphereIsWhereItIs) {
  constexpr double kSphere = 0.06;  // m, of synthetic:sphere
  Touched touched(without_normals(synthetic_cloud("sphere")));
  std::vector<double> off;
  for (int i = 0; i < kHands; ++i) {
    const Vector3d out = direction(i);
    const Vector3d proxy = touched.rest(1.3 * kSphere * out, (kSphere - kDeep) * out);
    off.push_back(proxy.norm() - kSphere);
    EXPECT_NEAR(touched.force().normalized().dot(out), 1, 1e-4);
  }
  EXPECT_LT(rms(off), 1e-3 * touched.radius());
}

TEST(PrepareAndTouch, ATorusIsWhereItIs) {
  constexpr double kRing = 0.07;  // m, of synthetic:torus
  constexpr double kTube = 0.03;
  Touched touched(without_normals(synthetic_cloud("torus")));
  std::vector<double> off;
  for (int i = 0; i < kHands; ++i) {
    const double turn = 2.4 * i;
    const double tube = 2 * std::numbers::pi * i / kHands;
    const Vector3d out(std::cos(turn), std::sin(turn), 0);
    const Vector3d normal = std::cos(tube) * out + std::sin(tube) * Vector3d::UnitZ();
    const Vector3d ring = kRing * out;
    const Vector3d proxy =
        touched.rest(ring + 1.3 * kTube * normal, ring + (kTube - kDeep) * normal);
    off.push_back((proxy - ring).norm() - kTube);
  }
  EXPECT_LT(rms(off), 1e-3 * touched.radius());
}

TEST(PrepareAndTouch, NormalsOfAClosedBodyPointOutward) {
  for (const char* const name : {"sphere", "torus"}) {
    const PointCloud cloud = synthetic_cloud(name);
    const SurfacePoints points = prepare(without_normals(cloud)).points;
    std::size_t inward = 0;
    std::vector<CellGrid::Neighbor> near;
    const CellGrid given(cloud.positions);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3f p =
          (points.origin - cloud.origin).cast<float>() + points.grid.points()[i];
      given.nearest(p, 1, near);
      const Eigen::Vector3f& truth = cloud.normals[given.order()[near.front().index]];
      if (points.normals[i].dot(truth) < 0) ++inward;
    }
    EXPECT_EQ(inward, 0u) << name;
  }
}

TEST(PrepareAndTouch, NormalsFaceTheViewpoint) {
  PointCloud wall = without_normals(synthetic_cloud("bumps"));
  const Vector3d eye(0, 0, -1);
  wall.viewpoint = eye;
  const SurfacePoints points = prepare(wall).points;
  ASSERT_FALSE(points.normals.empty());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3d p = points.origin + points.grid.points()[i].cast<double>();
    if (points.confidences[i] < 0.5f) continue;
    EXPECT_GT((eye - p).dot(points.normals[i].cast<double>()), 0);
  }
}

TEST(PrepareAndTouch, APlyFileBecomesAForce) {
  const std::filesystem::path path =
      std::filesystem::path(testing::TempDir()) / "prepare_and_touch.ply";
  const PointCloud cloud = synthetic_cloud("sphere");
  {
    std::ofstream file(path);
    file << "ply\nformat ascii 1.0\nelement vertex " << cloud.size()
         << "\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
    file.precision(9);
    for (std::size_t i = 0; i < cloud.size(); ++i) file << cloud.point(i).transpose() << '\n';
  }
  Touched touched(read_cloud(path));
  std::filesystem::remove(path);
  const Vector3d proxy = touched.rest({0.08, 0, 0}, {0.06 - kDeep, 0, 0});
  EXPECT_NEAR(proxy.x(), 0.06, 0.1 * touched.radius());
  EXPECT_GT(touched.force().x(), 0.1);
}

/// A hand that comes to the point from outside rests near it, pushed outward.
TEST(PrepareAndTouch, TheBunnyIsWhereItsPointsAre) {
  const char* const data = std::getenv("PALPATE_DATA");
  const std::filesystem::path path =
      std::filesystem::path(data ? data : "") / "stanford_bunny/bun_zipper_res2.ply";
  if (!data || !std::filesystem::exists(path)) GTEST_SKIP() << "no PALPATE_DATA";
  Touched touched(read_cloud(path));
  const SurfacePoints& points = touched.points();
  std::vector<double> off;
  std::size_t lost = 0;
  for (int i = 0; i < kHands; ++i) {
    const std::size_t k = static_cast<std::size_t>(i) * points.size() / kHands;
    const Vector3d p = points.origin + points.grid.points()[k].cast<double>();
    const Vector3d n = points.normals[k].cast<double>();
    const double radius = static_cast<double>(points.radii[k]);
    const Vector3d proxy = touched.rest(p + radius * n, p - 0.3 * radius * n);
    if (touched.force().dot(n) <= 0) {
      ++lost;
      continue;
    }
    off.push_back((proxy - p).dot(n) / radius);
  }
  EXPECT_LE(lost, 3u);  // below its ears and at its holes
  EXPECT_LT(rms(off), 0.05);
}

}  // namespace
}  // namespace palpate
