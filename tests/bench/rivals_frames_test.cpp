// Methods on triangles of a depth image have to match their own theory.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <numbers>

#include "base/numbers.hpp"
#include "rivals/compare.hpp"
#include "rivals/frame_mesh.hpp"

namespace palpate::rivals {
namespace {

using Eigen::Vector3d;

constexpr int kPixels = 120;
constexpr double kAway = 1;     // m from the camera to the plane z = 0
constexpr double kSide = 2e-3;  // m between pixels there

// A camera at (0, 0, kAway) that looks down on a height over its pixels.
DepthFrame frame_of(const std::function<double(int, int)>& height) {
  DepthFrame frame;
  const double f = kAway / kSide;
  frame.camera = {kPixels, kPixels, {f, f, kPixels / 2.0, kPixels / 2.0}, {}};
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Vector3d(1, -1, -1).asDiagonal();
  pose.translation() = Vector3d(0, 0, kAway);
  frame.T_world_sensor = pose;
  for (int v = 0; v < kPixels; ++v) {
    for (int u = 0; u < kPixels; ++u) {
      frame.depth.push_back(static_cast<float>(kAway - height(u, v)));
    }
  }
  return frame;
}

DepthFrame noisy_plane(double sigma) {
  Random random(1);
  return frame_of([&](int, int) { return sigma * random.normal(); });
}

// Depth of a ball of this radius whose top is at the origin.
DepthFrame ball_frame(double radius) {
  return frame_of([&](int u, int v) {
    const double x = (u - kPixels / 2.0) * kSide / kAway, y = (v - kPixels / 2.0) * kSide / kAway;
    // The ray (x, y, 1) t meets |p - c| = radius with c = kAway + radius along the axis.
    const double c = kAway + radius;
    const double square = 1 + x * x + y * y;
    const double t = (c - std::sqrt(c * c - square * (c * c - radius * radius))) / square;
    return kAway - t;
  });
}

std::unique_ptr<Rival> shown(const char* name, const DepthFrame& frame, double scale = 1) {
  std::unique_ptr<Rival> rival = method_named(name).make(scale);
  rival->show({&frame, nullptr, kSide});
  return rival;
}

double degrees(double radians) {
  return radians * 180 / std::numbers::pi;
}

double angle_to(const Vector3d& force, const Vector3d& normal) {
  return std::atan2(force.cross(normal).norm(), force.dot(normal));
}

TEST(Rivals, FacetsOfNoiseLeanByTwoSigmaOverSpacing) {
  const double sigma = 2e-5;
  const FrameMesh mesh(noisy_plane(sigma), 5);
  double squares = 0;
  int count = 0;
  std::vector<FrameMesh::Triangle> around;
  for (int i = 0; i < mesh.vertices(); ++i) {
    mesh.triangles_at(i, around);
    for (const FrameMesh::Triangle& t : around) {
      const double angle = angle_to(mesh.normal(t), -Vector3d::UnitZ());
      squares += angle * angle;
      ++count;
    }
  }
  ASSERT_GT(count, 10000);
  EXPECT_NEAR(std::sqrt(squares / count) / (2 * sigma / kSide), 1, 0.05);
}

TEST(Rivals, TerrainOfAnExactPlaneHasNoTangentialForce) {
  const DepthFrame frame = frame_of([](int, int) { return 0; });
  for (const char* name : {"terrain", "shaded"}) {
    const std::unique_ptr<Rival> rival = shown(name, frame);
    rival->reset({-0.05, 0.01, 0.01});
    for (int i = 0; i < 1000; ++i) {
      const Step step = rival->step({-0.05 + 1e-4 * i, 0.01 + 3e-5 * i, -3e-3});
      ASSERT_NEAR(step.force.z(), kStiffness * 3e-3, 1e-3) << name << i;
      ASSERT_LT(step.force.head<2>().norm(), 1e-3) << name << i;
    }
  }
}

// The RMS and the largest angle of forces on a ball, rad.
std::pair<double, double> angles_on_ball(const char* name, double radius) {
  const DepthFrame frame = ball_frame(radius);
  const std::unique_ptr<Rival> rival = shown(name, frame);
  rival->reset({-0.03, 0, 0.01});
  double squares = 0, largest = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vector3d out = Vector3d(-0.03 + 3e-5 * i, 0.4e-5 * i, radius).normalized();
    const Step step = rival->step(out * (radius - 2e-3) - Vector3d(0, 0, radius));
    if (i < 100) continue;
    const double angle = angle_to(step.force, out);
    squares += angle * angle / 1900;
    largest = std::max(largest, angle);
  }
  return {std::sqrt(squares), largest};
}

TEST(Rivals, ShadingTakesMostOfTheFacetsOfABall) {
  const double radius = 0.1;
  const auto [flat, flat_most] = angles_on_ball("terrain", radius);
  const auto [smooth, smooth_most] = angles_on_ball("shaded", radius);
  EXPECT_LT(flat_most, 1.05 * kSide / (std::sqrt(2.0) * radius));
  EXPECT_GT(flat_most, 0.5 * kSide / (std::sqrt(2.0) * radius));
  EXPECT_LT(smooth, flat / 4) << degrees(smooth) << " " << degrees(flat);
}

TEST(Rivals, TerrainIsNeverFallenThrough) {
  // No hole: with a jump that large all neighbours are joined.
  const DepthFrame frame = noisy_plane(1e-3);
  for (const char* name : {"terrain", "shaded"}) {
    const std::unique_ptr<Rival> rival = shown(name, frame, 10);
    Random random(7);
    Vector3d hand(0, 0, 0.01);
    rival->reset(hand);
    for (int i = 0; i < 20000; ++i) {
      hand += 3e-4 * Vector3d(random.normal(), random.normal(), random.normal());
      hand = hand.cwiseMax(Vector3d(-0.08, -0.08, -0.03)).cwiseMin(Vector3d(0.08, 0.08, -5e-3));
      const Step step = rival->step(hand);
      ASSERT_GT(step.proxy.z(), -5e-3) << name << ", step " << i;
    }
  }
}

TEST(Rivals, GraphPullsSidewaysByUpToThreeTenthsOfTheSpacing) {
  const DepthFrame frame = frame_of([](int, int) { return 0; });
  const std::unique_ptr<Rival> rival = shown("graph", frame);
  rival->reset({-0.05, 0.013, 0.01});
  double most = 0;
  for (int i = 0; i < 4000; ++i) {
    const Step step = rival->step({-0.05 + 2.5e-5 * i, 0.013 + 0.31e-5 * i, -3e-3});
    ASSERT_NEAR(step.force.z(), kStiffness * 3e-3, 1e-3);
    most = std::max(most, step.force.head<2>().norm());
  }
  const double bound = (1 - std::sqrt(0.5)) * kStiffness * kSide;
  EXPECT_LE(most, 1.001 * bound);
  EXPECT_GE(most, 0.28 * kStiffness * kSide);
}

TEST(Rivals, GraphEndsItsContactAboveTheSurface) {
  const DepthFrame frame = frame_of([](int, int) { return 0; });
  const std::unique_ptr<Rival> rival = shown("graph", frame);
  rival->reset({0.0101, 0.0103, 0.01});
  EXPECT_FALSE(rival->step({0.0101, 0.0103, 0.001}).touching);
  EXPECT_TRUE(rival->step({0.0101, 0.0103, -0.001}).touching);
  EXPECT_FALSE(rival->step({0.0101, 0.0103, 0.001}).touching);
}

TEST(Rivals, OnTrianglesKeepTheirContactFromFrameToFrame) {
  Random random(11);
  std::vector<DepthFrame> frames;
  for (int i = 0; i < 10; ++i) {
    frames.push_back(frame_of([&](int, int) { return 2e-5 * random.normal(); }));
  }
  for (const char* name : {"terrain", "shaded", "graph", "video"}) {
    const std::unique_ptr<Rival> rival = shown(name, frames[0]);
    for (int place = 0; place < 10; ++place) {
      const Vector3d hand(0.05 * random.uniform(), 0.05 * random.uniform(), -0.003);
      rival->reset({hand.x(), hand.y(), 0.01});
      for (const DepthFrame& frame : frames) {
        for (int tick = 0; tick < 33; ++tick) {
          ASSERT_NEAR(rival->step(hand).force.z(), 0.003 * kStiffness, 0.1) << name << place;
        }
        rival->show({&frame, nullptr, kSide});
      }
    }
  }
}

TEST(Rivals, AreNamedInTheErrorWhereOneIsNotKnown) {
  try {
    (void)method_named("graf");
    FAIL();
  } catch (const std::exception& error) {
    EXPECT_NE(std::string(error.what()).find("there are ours, "), std::string::npos);
  }
}

}  // namespace
}  // namespace palpate::rivals
