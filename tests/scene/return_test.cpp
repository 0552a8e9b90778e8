// A hand presses while its camera is silent, or sees nothing there, and is behind the surface when
// that comes back: it is held again from the side that it was on, goes out, and feels it again.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "palpate/scene/scene.hpp"
#include "support/depth_frames.hpp"
#include "support/rates.hpp"
#include "support/stream_run.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using test::kFrame;

constexpr double kFade = 0.2;
constexpr double kSilent = 0.6;  // s, from then on
constexpr double kBack = 1.6;
constexpr double kHeld = 0.3;  // s after which the hand is held again
constexpr double kLift = 2.2;
constexpr double kAgain = 2.8;  // presses again
constexpr double kEnd = 3.2;
constexpr double kDeep = 6e-3;  // m below the points

const CameraModel kCamera{48, 36, {100, 100, 23.5, 17.5}, {}};  // a pixel sees 5 mm

struct Case {
  std::string name;
  FieldOptions field;
  Policy policy = Policy::morph;
  bool clouds = false;  // frames are given as points
  bool paper = false;
  bool dark = false;  // of the first frame little is seen
  bool held = true;   // as soon as the surface is back
};

FieldOptions kind(FieldOptions::Kind kind) {
  FieldOptions options;
  options.kind = kind;
  return options;
}
FieldOptions tool() {
  FieldOptions options;
  options.tool_radius = 4e-3;
  return options;
}

PointCloud points_of(const DepthFrame& frame) {
  const Pinhole& p = frame.camera.pinhole;
  PointCloud cloud;
  cloud.viewpoint = Vector3d::Zero();
  cloud.width = static_cast<std::size_t>(frame.camera.width);
  cloud.height = static_cast<std::size_t>(frame.camera.height);
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    const auto z = static_cast<double>(frame.depth[i]);
    if (z <= 0) continue;
    const Vector3d ray((static_cast<double>(i % cloud.width) - p.cx) / p.fx,
                       (static_cast<double>(i / cloud.width) - p.cy) / p.fy, 1);
    cloud.positions.push_back((z * ray).cast<float>());
    cloud.pixels.push_back(static_cast<std::uint32_t>(i));
  }
  return cloud;
}

// Leaves 8 pixels far from one another.
void darken(DepthFrame& frame) {
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    if (i % 211 != 7) frame.depth[i] = 0;
  }
}

// What a press of this force comes back with: the tank holds 20 mJ, which a stiffer spring of
// 500 N/m had stored, and gives no more (method.md 3.5).
double paid_for(double force) {
  return std::min(force, 0.04 * 500 / force);
}

class Returning : public testing::TestWithParam<Case> {
 protected:
  /// The least and last force upward that the hand feels.
  void run(bool hole, const Vector3d& normal) {
    pressed_ = least_ = last_ = 0;
    held_ = 1e9;
    went_behind_ = false;
    const Case& c = GetParam();
    SourceOptions options;
    options.T_world_sensor = test::looking_down();
    options.policy.policy = c.policy;
    options.policy.silence = options.policy.fade = kFade;
    options.prepare.paper = c.paper;
    Scene scene;
    Source& source = scene.add("camera", options);
    test::StreamRun run(scene, {}, c.field);
    const test::DepthOf plane = test::plane_depth({0, 0, 0.5}, normal.normalized());
    for (int k = 0; k * kFrame < kEnd; ++k) {
      const double stamp = k * kFrame;
      const bool gone = stamp > kSilent && stamp < kBack;
      if (gone && !hole) continue;
      const test::DepthOf seen = [=](double x, double y) {
        return gone && std::hypot(x, y) < 0.09 ? 0 : plane(x, y);
      };
      DepthFrame frame = test::frame_of(kCamera, stamp, seen, 3e-4, static_cast<unsigned>(k) + 1);
      if (c.dark && k == 0) darken(frame);
      run.at(stamp, [=, &source, &c] {
        const auto start = [=] { return stamp + 2e-3; };
        c.clouds ? source.push(points_of(frame), stamp, start) : source.push(frame, start);
      });
    }
    run.until(
        kEnd,
        [](double t) {
          const double goal = t < 0.2 || (t > kLift && t < kAgain) ? 0.04 : -kDeep;
          const double since = t - (t < kLift ? 0.2 : t < kAgain ? kLift : kAgain);
          const double way = std::clamp(0.25 * since, 0.0, 0.04 + kDeep);
          return Vector3d(2e-3, -1e-3, t < 0.2 ? goal : goal < 0 ? 0.04 - way : way - kDeep);
        },
        [&](double t, const Contact& contact) {
          const double force = contact.force.z();
          if (t < kSilent) pressed_ = std::max(pressed_, force);
          if (t > kSilent) least_ = std::min(least_, force);
          if (t > kBack + kHeld && t < kLift) held_ = std::min(held_, force);
          went_behind_ |= t > kBack && t < kLift && has(run.field().notes(), FieldNote::behind);
          last_ = force;
        });
  }

  double pressed_ = 0;  // N
  double least_ = 0;
  double last_ = 0;
  double held_ = 0;  // once the surface is back, the least
  bool went_behind_ = false;
};

TEST_P(Returning, ASurfaceLetsAHandOutAndHoldsItAgain) {
  for (const bool hole : {false, true}) {
    for (const Vector3d& normal : {Vector3d(0, 0, -1), Vector3d(0.4, 0.2, -1)}) {
      SCOPED_TRACE(::testing::Message() << (hole ? "a hole, " : "silence, ") << normal.transpose());
      run(hole, normal);
      EXPECT_GT(pressed_, 1.9);
      if (GetParam().held) {
        const double paid = paid_for(pressed_);
        EXPECT_GT(held_, (paid < pressed_ ? 0.8 : 0.9) * paid);
      }
      EXPECT_TRUE(went_behind_ || held_ > 0);
      EXPECT_GT(least_, -0.1) << "held from behind";
      EXPECT_GT(last_, 1.9) << "not held any more";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    OfWhatACameraSees, Returning,
    testing::Values(Case{"Blocks", {}}, Case{"BlocksWithATool", tool()},
                    Case{"BlocksPointset", kind(FieldOptions::Kind::pointset)},
                    Case{"BlocksMetaball", kind(FieldOptions::Kind::metaball)},
                    Case{"Replace", {}, Policy::replace},
                    Case{"CloudsWithATool", tool(), Policy::crossfade, true, false, false, false},
                    Case{"CloudsAfterADarkOne", {}, Policy::crossfade, true, false, true, false},
                    Case{"Paper", paper_field(), Policy::average, true, true}),
    [](const auto& made) { return made.param.name; });

}  // namespace
}  // namespace palpate
