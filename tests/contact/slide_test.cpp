#include "contact/slide.hpp"

#include <gtest/gtest.h>

#include "contact/sweep.hpp"
#include "contact/test_fields.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

const SurfacePoint kStart{
    .position = Vector3d::Zero(), .normal = Vector3d::UnitZ(), .radius = 0.01};
const Vector3d kAbove(0, 0, 0.1);

TEST(Slide, ReleaseThatFewEvaluationsAreLeftForIsPostponed) {
  DoubtfulField field;
  field.floor = 0;
  Probe probe(field, kNoTexture, 0.01);
  probe.swept = kSweepBudget - 100;
  const Slide motion = slide(probe, kStart, kAbove, false, {});
  EXPECT_EQ(motion.end, Slide::End::postponed);
  EXPECT_EQ(motion.at.position, kStart.position);
  EXPECT_LE(probe.evaluations(), 120);
}

TEST(Slide, ReleaseThatEvenAWholeBudgetIsTooShortForGoesOnInFreeSpace) {
  DoubtfulField field;
  field.floor = 0;
  Probe probe(field, kNoTexture, 0.01);
  const Slide motion = slide(probe, kStart, kAbove, false, {});
  EXPECT_EQ(motion.end, Slide::End::interrupted);
  EXPECT_GT(motion.at.position.z(), 1e-4);
  EXPECT_LT(motion.at.position.z(), kAbove.z());
}

// Four radii deep in a hollow, a whole tangent overshoots four times.
TEST(Slide, HollowTakesFewSubSteps) {
  const BowlField bowl(0.01);
  Probe probe(bowl, kNoTexture, 0.01);
  const SurfacePoint bottom{.position = {0, 0, -0.01}, .normal = Vector3d::UnitZ(), .radius = 0.01};
  const Vector3d direction = Vector3d(0.4, 0.1, -1).normalized();
  const Slide motion = slide(probe, bottom, 0.04 * direction, false, {});
  EXPECT_EQ(motion.end, Slide::End::resting);
  EXPECT_LT((motion.at.position - 0.01 * direction).norm(), 1e-5);
  EXPECT_LE(motion.iterations, 6);
  EXPECT_LE(probe.evaluations(), 20);
  RecordProperty("iterations", motion.iterations);
  RecordProperty("evaluations", probe.evaluations());
}

}  // namespace
}  // namespace palpate::test
