#include "contact/slide.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "contact/drive.hpp"
#include "contact/probe.hpp"
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
  probe.swept = kSweepWork - 100 * kEvaluationWork;
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

/// A hollow whose every sample sums over 2000 points.
class DenseField final : public Field {
 public:
  [[nodiscard]] Sample sample(const Vector3d& x) const noexcept override {
    summed_ += 2000;
    return bowl_.sample(x);
  }
  [[nodiscard]] bool is_free(const Ball& ball) const noexcept override {
    return bowl_.is_free(ball);
  }
  [[nodiscard]] Surface surface(const Vector3d&) const noexcept override { return {}; }
  [[nodiscard]] Field::Traits traits() const noexcept override { return bowl_.traits(); }
  void begin_step() const noexcept override { summed_ = 0; }
  [[nodiscard]] int points_summed() const noexcept override { return summed_; }

 private:
  BowlField bowl_{0.01};
  mutable int summed_ = 0;
};

TEST(Slide, StopsWhereAStepHasSummedEnoughAndGoesOnInTheNext) {
  const DenseField dense;
  const BowlField bowl(0.01);
  const Vector3d hand(0.03, 0, -0.03);
  Proxy slow{{.max_iterations = 4}};
  Proxy quick;
  slow.reset(Vector3d::Zero());
  quick.reset(Vector3d::Zero());
  int unfinished = 0;
  for (int k = 0; k < 60; ++k) {
    unfinished += has(slow.step(dense, hand, 1e-3).notes, ContactNote::not_converged) ? 1 : 0;
    EXPECT_LE(dense.points_summed(), 4 * 640 + 32000 + 2 * 11 * 2000);
    (void)quick.step(bowl, hand, 1e-3);
  }
  EXPECT_GT(unfinished, 0);
  EXPECT_LT((slow.position() - quick.position()).norm(), 1e-5);
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

TEST(FindSurface, ThatMovedALittleNeedsNoSweep) {
  const Vector3d hip(0.004, 0, -0.003);
  for (const double dz : {-2e-3, -1e-3, 1e-3, 2e-3}) {  // R / 4 is 2.5 mm
    SheetField sheet;
    sheet.reach = 0.02;
    Proxy proxy;
    proxy.reset({0.004, 0, 0.03});
    drive(proxy, sheet, {0.004, 0, 0.03}, hip, 0.1);
    const int still = proxy.step(sheet, hip, kTick).evaluations;
    sheet.height = dz;
    ++sheet.revision;
    const Contact c = proxy.step(sheet, hip, kTick);
    EXPECT_TRUE(has(c.notes, ContactNote::reanchored)) << dz;
    EXPECT_LE(c.evaluations, still + 2) << dz;
  }
}

/// Solid up to 12 mm, without a slope that leads out of it from farther below; every sample sums
/// over 20 000 points.
class BuriedField final : public Field {
 public:
  [[nodiscard]] Sample sample(const Vector3d& x) const noexcept override {
    summed_ += 20000;
    const double height = x.z() - 0.012;
    const Vector3d slope = height > -1e-3 ? Vector3d::UnitZ().eval() : Vector3d::Zero().eval();
    return {.value = height, .gradient = slope, .support = 1, .radius = 0.01};
  }
  [[nodiscard]] bool is_free(const Ball&) const noexcept override { return false; }
  [[nodiscard]] Surface surface(const Vector3d&) const noexcept override { return {}; }
  [[nodiscard]] Field::Traits traits() const noexcept override { return {.resolution = 1e-3}; }
  void begin_step() const noexcept override { summed_ = 0; }
  [[nodiscard]] int points_summed() const noexcept override { return summed_; }

 private:
  mutable int summed_ = 0;
};

TEST(FindSurface, SearchThatTheBudgetEndsGoesOnInTheNextStep) {
  const BuriedField field;
  int looked = 0;
  std::vector<int> ends;
  std::optional<SurfacePoint> found;
  while (!found && ends.size() < 10) {
    Probe probe(field, kNoTexture, 0.01);
    found = recover(probe, Vector3d::Zero(), Vector3d::UnitZ(), looked);
    EXPECT_LE(probe.swept, kSweepWork + 20000 + kEvaluationWork);
    ends.push_back(looked);
  }
  EXPECT_EQ(ends, (std::vector<int>{2, 4, 0}));  // the fifth place, R / 4 apart, is free
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->position.z(), 0.012, 1e-6);
}

// A look from above that takes the whole budget in every step must not keep it from ever beginning.
TEST(FindSurface, SearchTakesALookEvenWhereTheBudgetIsSpent) {
  const BuriedField field;
  int looked = 0;
  for (const int wanted : {1, 2, 3, 4}) {
    Probe probe(field, kNoTexture, 0.01);
    probe.swept = kSweepWork;
    EXPECT_FALSE(recover(probe, Vector3d::Zero(), Vector3d::UnitZ(), looked));
    EXPECT_EQ(looked, wanted);
  }
}

TEST(FindSurface, SearchThatFindsNothingBeginsAgain) {
  const BuriedField field;
  int looked = 0;
  for (const int wanted : {2, 4, 6, 0, 2}) {
    Probe probe(field, kNoTexture, 0.01);
    EXPECT_FALSE(recover(probe, {0, 0, -0.02}, Vector3d::UnitZ(), looked));
    EXPECT_EQ(looked, wanted);
  }
}

}  // namespace
}  // namespace palpate::test
