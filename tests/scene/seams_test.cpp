// Slides a hand over the seams between several cameras.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "support/depth_frames.hpp"
#include "support/rates.hpp"
#include "support/snapshots.hpp"
#include "support/stream_run.hpp"

namespace palpate {
namespace {

using test::kFrame;

using Eigen::Vector3d;

// Cameras side by side along x, so far apart that neighbours share a third of what they see of the
// plane z = 0, each turned a little, none of them in step.
class SeamsTest : public testing::TestWithParam<int> {
 protected:
  SeamsTest() {
    for (int c = 0; c < GetParam(); ++c) {
      SourceOptions options;
      const double middle = 0.14 * (c - 0.5 * (GetParam() - 1));
      options.T_world_sensor = Eigen::Translation3d(middle, 0, 0) *
                               Eigen::AngleAxisd(0.3 * c, Vector3d::UnitZ()) * test::looking_down();
      options.policy.fit_everywhere = true;
      scene_.add("camera " + std::to_string(c), options);
    }
  }

  // Every camera sees the plane at the height it has at the stamp.
  void push(double stamp, double height, double noise) {
    for (std::size_t c = 0; c < scene_.size(); ++c) {
      const double own = stamp + kFrame * static_cast<double>(c) / 4;
      const auto seed = static_cast<unsigned>(1000 * stamp) + static_cast<unsigned>(c);
      scene_.source(c).push(
          test::frame_of(test::small_camera(), own, test::wall(0.5 - height), noise, seed),
          [=] { return own; });
    }
  }

  Scene scene_;
};

// A hand that slides over all seams feels one plane: no bump where supports unite.
TEST_P(SeamsTest, APlaneIsOnePlane) {
  push(0, 0, 0);
  SceneField field(scene_);
  const double half = 0.06 + 0.07 * (GetParam() - 1);
  for (double x = -half; x <= half; x += 2e-3) {
    const Vector3d place(x, 3e-3, 2e-3);
    field.update_from(0.06, place, place);
    const Sample sample = field.sample(place);
    EXPECT_NEAR(sample.value, 2e-3, 3e-5) << x;
    EXPECT_NEAR(sample.gradient.normalized().z(), 1, 1e-4) << x;
    EXPECT_GT(sample.support, 0.6) << x;
    EXPECT_LT(sample.support, 1.8) << x;
  }
}

// A metaball's plane rises by (n^1/4 - 1) at most where n cameras agree (docs/method.md 2.9).
TEST_P(SeamsTest, AMetaballRisesLittleWhereTheyAgree) {
  push(0, 0, 0);
  SceneField field(scene_, {.kind = FieldOptions::Kind::metaball});
  double lowest = 1;
  double highest = 0;
  const double half = 0.05 + 0.07 * (GetParam() - 1);
  for (double x = -half; x <= half; x += 5e-3) {
    field.update_from(0.06, {x, 0, 5e-3}, {x, 0, 5e-3});
    double low = 0;
    double high = 15e-3;
    for (int i = 0; i < 40; ++i) {
      const double z = 0.5 * (low + high);
      (field.sample({x, 0, z}).value < 0 ? low : high) = z;
    }
    lowest = std::min(lowest, low);
    highest = std::max(highest, low);
  }
  const double radius = scene_.source(0).points()->radius;
  EXPECT_GT(lowest, 0.40 * radius);
  EXPECT_LT(highest - lowest, 0.12 * radius);
}

// Cameras that are not in step, with noise, while a hand presses on a seam.
TEST_P(SeamsTest, StreamsDoNotShake) {
  test::StreamRun run(scene_);
  for (int k = 0; k < 25; ++k) {
    run.at(k * kFrame, [=, this] { push(k * kFrame, 0, 4e-4); });
  }
  Vector3d last = Vector3d::Zero();
  double step = 0;
  int lost = 0;
  run.until(
      0.8, [](double t) { return Vector3d(0.07, 0, t < 0.2 ? 0.02 : -3e-3); },
      [&](double t, const Contact& contact) {
        if (t > 0.45) {
          step = std::max(step, (contact.force - last).norm());
          lost += contact.touching ? 0 : 1;
        }
        last = contact.force;
      });
  EXPECT_EQ(lost, 0);
  EXPECT_LT(step, 0.02);
}

INSTANTIATE_TEST_SUITE_P(Cameras, SeamsTest, testing::Values(1, 2, 3, 4));

}  // namespace
}  // namespace palpate
