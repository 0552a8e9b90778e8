// Checks that a hand goes up and down a step of a cloud: what it touched last, and left, decides
// neither what holds it below nor what holds it above.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>

#include "geometry/clouds.hpp"
#include "palpate/contact/proxy.hpp"
#include "palpate/scene/scene_field.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr double kBetween = 1e-3;  // m, from point to point

/// A step of the height given in spacings: a floor at x < 0, a wall, and a tread, in any pose.
class CloudStep : public testing::TestWithParam<int> {
 protected:
  CloudStep() {
    test::Clouds clouds(static_cast<unsigned>(GetParam()));
    pose_.linear() = Eigen::Quaterniond(clouds.uniform(0.2, 1), clouds.uniform(-1, 1),
                                        clouds.uniform(-1, 1), clouds.uniform(-1, 1))
                         .normalized()
                         .toRotationMatrix();
    PointCloud cloud;
    const auto add = [&](double x, double y, double z) {
      cloud.positions.push_back((kBetween * (pose_ * Vector3d(x, y, z))).cast<float>());
    };
    const auto off = [&] { return clouds.uniform(0.3, 0.7); };
    for (int i = 0; i < 20; ++i) {
      for (int j = -20; j < 20; ++j) {
        add(i + off() - 20, j + off(), 0);
        add(i + off(), j + off(), height());
        if (i < height()) add(0, j + off(), i + off());
      }
    }
    scene_.add("step", cloud);
    field_.emplace(scene_);
  }

  [[nodiscard]] static int height() { return GetParam(); }

  /// Moves the hand to x and z, at y = 0, 0.05 spacings a step; all in spacings. Returns the force,
  /// N. Notes how low the proxy comes.
  double go(double x, double z) {
    const Vector3d to(x, 0, z);
    while (hand_ != to) {
      const Vector3d way = to - hand_;
      hand_ += way * std::min(1.0, 0.05 / way.norm());
      const Vector3d at = kBetween * (pose_ * hand_);
      field_->update(time_ += 1e-3, at, proxy_);
      contact_ = proxy_.step(*field_, at, 1e-3);
      lowest_ = std::min(lowest_, (pose_.inverse() * (contact_.proxy / kBetween)).z());
      if ((to - hand_).norm() < 1e-9) hand_ = to;
    }
    return contact_.force.norm();
  }

  Eigen::Isometry3d pose_ = Eigen::Isometry3d::Identity();
  Scene scene_;
  std::optional<SceneField> field_;
  Proxy proxy_;
  Contact contact_;
  Vector3d hand_{8, 0, 25};
  double time_ = 0;
  double lowest_ = 100;
};

TEST_P(CloudStep, HoldsAHandThatComesDownAlongItsWall) {
  go(6, height() - 0.5);
  go(0.2, height() - 0.5);
  go(0.2, -1.0);
  EXPECT_GT(go(-1, -1.0), 0.2);
  go(-3, -1.0);
  EXPECT_GT(lowest_, -0.5);
  EXPECT_EQ(go(-3, 4), 0);
}

TEST_P(CloudStep, HoldsAHandThatComesOutOfItBelow) {
  go(6, height() - 0.5);
  go(6, -1.0);
  EXPECT_GT(go(-3, -1.0), 0.2);
  EXPECT_GT(lowest_, -0.5);
  EXPECT_EQ(go(-3, 4), 0);
}

TEST_P(CloudStep, StopsAHandAtItsFoot) {
  go(-5, 25);
  go(-5, -0.7);
  EXPECT_GT(go(4, -0.7), 1);
  EXPECT_LT((pose_.inverse() * (contact_.proxy / kBetween)).x(), 0.5);
  EXPECT_EQ(go(4, height() + 10), 0);
}

TEST_P(CloudStep, LetsAHandGoThatLeavesItAlongItsWall) {
  for (const double pressed : {1.0, 2.0, 3.0}) {
    go(-5, 5);
    go(-5, -0.5);
    go(pressed, -0.5);
    EXPECT_EQ(go(pressed, height() + 6), 0) << pressed;
    go(-5, height() + 6);
  }
}

INSTANTIATE_TEST_SUITE_P(OfHeight, CloudStep, testing::Values(3, 4, 6, 8, 12));

}  // namespace
}  // namespace palpate
