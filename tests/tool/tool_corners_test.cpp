// A tool that rests in a corner of a cloud keeps its force and stands still.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "palpate/contact/proxy.hpp"
#include "palpate/scene/scene_field.hpp"
#include "support/effort.hpp"
#include "tool/held_tool.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

constexpr double kBall = 2e-3;  // m

/// Two or three sheets that meet in the origin, and the direction out of them.
struct Corner {
  explicit Corner(int walls, double noise) : out(Vector3d(walls == 3 ? 1 : 0, 1, 1).normalized()) {
    Eigen::Isometry3d wall = Eigen::Isometry3d::Identity();
    Sampling sampling{.noise = noise};
    const double half = 0.04;
    const double s = sampling.spacing;
    const double from = walls == 3 ? s : -half;
    for (int i = 0; i < walls; ++i, ++sampling.seed) {
      const std::vector<TestPoint> more = sheet(
          sampling, {walls == 3 || i == 1 ? s : -half, i == 0 ? s : from}, {half, half}, wall);
      points.insert(points.end(), more.begin(), more.end());
      Eigen::Matrix3d turn;
      turn << 0, 1, 0, 0, 0, 1, 1, 0, 0;
      wall.linear() = turn * wall.linear();
    }
  }

  std::vector<TestPoint> points;
  Vector3d out;
};

/// What a tool at rest does.
struct Rest {
  double begun = 0;  // N
  double least = std::numeric_limits<double>::infinity();
  double path = 0;  // of the proxy, m
  int steps = 200 + effort(2000);
};

class ToolInACorner : public testing::TestWithParam<int> {
 protected:
  static SourceOptions options() {
    SourceOptions options;
    options.prepare.radius = 10e-3;
    return options;
  }
  static Pose held(const Tool& tool, const Vector3d& position, const Vector3d& out) {
    Pose pose = pose_at(position);
    if (tool.samples().front().radius > 0) {  // a stylus points into the corner
      pose.orientation = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), out);
    }
    return pose;
  }
  // Presses a tool into it, `deep` (m) beyond the origin with what is its tip, and lets it rest.
  static Rest rest(Scene& scene, const Tool& tool, const Vector3d& out, double tip, double deep) {
    HeldTool in_hand(scene, tool, {});
    in_hand.reset(held(tool, (tip + 0.035) * out, out));
    const Pose end = held(tool, (tip - deep) * out, out);
    in_hand.to(end, 400, 1000);
    Rest rest;
    Vector3d last = in_hand.pose().position;
    for (int i = 0; i < rest.steps; ++i) {
      const ToolContact contact = in_hand.step(end);
      if (i == 0) rest.begun = contact.wrench.force.norm();
      rest.least = std::min(rest.least, contact.wrench.force.norm());
      rest.path += (contact.proxy.position - last).norm();
      last = contact.proxy.position;
    }
    return rest;
  }
  static double felt_by_point(Scene& scene, const Vector3d& out, double deep) {
    SceneField field(scene, {.tool_radius = kBall});
    Proxy proxy;
    proxy.reset(0.035 * out);
    Contact contact;
    for (int i = 0; i < 1200; ++i) {
      const Vector3d hand = std::max(-deep, 0.035 - 1e-4 * i) * out;
      field.update(1e-3 * i, hand, proxy);
      contact = proxy.step(field, hand, kTick);
    }
    return contact.force.norm();
  }
};

TEST_P(ToolInACorner, ABallFeelsWhatAPointWithItsRadiusFeels) {
  for (const double noise : {0.0, 0.1, 0.25}) {
    const Corner corner(GetParam(), noise);
    Scene scene;
    scene.add("corner", cloud_of(corner.points), options());
    for (const double deep : {4e-3, 8e-3, 12e-3}) {
      SCOPED_TRACE(testing::Message() << noise << " spacings, " << deep << " m");
      const double point = felt_by_point(scene, corner.out, deep);
      const Rest ball = rest(scene, Tool::ball(kBall), corner.out, 0, deep);
      EXPECT_NEAR(ball.begun, point, 0.05 * point);
      EXPECT_GT(ball.least, 0.95 * point);
      EXPECT_LT(ball.path, 5e-4);
    }
  }
}

/// Two sheets of 5 mm that meet along y at 60 degrees, another surface in each step.
class SheetsOfAGroove final : public Field {
 public:
  [[nodiscard]] Sample sample(const Vector3d& x) const noexcept override {
    const Vector3d left(std::cos(kTilt), 0, std::sin(kTilt));
    const Vector3d right(-left.x(), 0, left.z());
    const Sample a = sheet_at(left.dot(x), left);
    const Sample b = sheet_at(right.dot(x), right);
    return a.value < b.value ? a : b;
  }
  [[nodiscard]] bool is_free(const Ball& ball) const noexcept override {
    return sample(ball.center).value > ball.radius;
  }
  [[nodiscard]] Surface surface(const Vector3d&) const noexcept override { return {.source = 0}; }
  [[nodiscard]] Traits traits() const noexcept override {
    return {.resolution = 2e-5, .revision = revision, .reanchor_reach = 0.016};
  }

  std::uint64_t revision = 0;

 private:
  static constexpr double kTilt = std::numbers::pi / 6;
  static constexpr double kThick = 5e-3;  // m

  static Sample sheet_at(double over, const Vector3d& normal) {
    Sample sample{.value = over, .gradient = normal, .support = 1, .radius = 0.01};
    if (over < -0.5 * kThick) {
      sample.value = -kThick - over;
      sample.gradient = -normal;
    }
    return sample;
  }
};

// Behind the other sheet it is free, and this sheet's normal leads there.
TEST(ToolInAGroove, NoChangeOfTheSurfaceLiftsItThroughASheet) {
  SheetsOfAGroove groove;
  ToolProxy proxy = proxy_of(Tool::ball(1e-3), kOptions);
  proxy.reset(pose_at({0, 0, 0.03}));
  ToolContact contact;
  double highest = 0;  // m, once the tool has come to rest
  for (int i = 0; i < 600; ++i) {
    ++groove.revision;
    contact = proxy.step(groove, pose_at({0, 0, std::max(-2e-3, 0.03 - 1e-4 * i)}), kTick);
    if (i > 400) highest = std::max(highest, contact.proxy.position.z());
  }
  EXPECT_NEAR(highest, 2e-3, 1e-5);
  EXPECT_NEAR(contact.wrench.force.z(), 4e-3 * kStiffness, 1e-2);
}

TEST_P(ToolInACorner, NoToolSwings) {
  for (const double noise : {0.0, 0.1, 0.25}) {
    const Corner corner(GetParam(), noise);
    Scene scene;
    scene.add("corner", cloud_of(corner.points), options());
    for (const auto& [name, tip] :
         {std::pair("capsule:40x2", 40e-3), std::pair("box:10x10x10", 8.6e-3)}) {
      for (const double deep : {4e-3, 12e-3}) {
        SCOPED_TRACE(testing::Message() << name << ", " << noise << " spacings, " << deep << " m");
        const Rest tool = rest(scene, Tool::from_text(name, 5e-3), corner.out, tip, deep);
        EXPECT_GT(tool.begun, 0.5);
        EXPECT_GT(tool.least, 0.95 * tool.begun);
        EXPECT_LT(tool.path, 20e-6 * tool.steps);  // 10 mN a step
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(OfWalls, ToolInACorner, testing::Values(2, 3));

}  // namespace
}  // namespace palpate::test
