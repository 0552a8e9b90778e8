// Contacts with a skin that holds towards one side alone, still and while it folds.
#include <gtest/gtest.h>

#include <cmath>

#include "contact/drive.hpp"
#include "palpate/contact/proxy.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

constexpr double kThick = 5e-3;  // m

/// A skin around a plane through the origin, which an eye at +z saw: solid for 5 mm below it, in
/// its front half alone.
class SkinField final : public Field {
 public:
  Vector3d normal = Vector3d::UnitZ();  // of the skin, unit
  std::uint64_t revision = 0;

  [[nodiscard]] Sample sample(const Vector3d& x) const noexcept override {
    const double height = normal.dot(x);
    const double back = -kThick - height;
    Sample sample{.value = std::max(height, back), .support = 1, .radius = 0.01};
    sample.gradient = height > back ? normal : Vector3d(-normal);
    sample.averted = sample.gradient.z() < -0.1;
    if (!sample.averted || sample.value > 0) return sample;
    return {.value = 3.5e-3, .support = 1, .radius = 0.01, .behind = true, .averted = true};
  }
  [[nodiscard]] bool is_free(const Ball& ball) const noexcept override {
    const double height = normal.dot(ball.center);
    return height > ball.radius || height < -kThick - ball.radius;
  }
  [[nodiscard]] Surface surface(const Vector3d&) const noexcept override { return {.source = 0}; }
  [[nodiscard]] Traits traits() const noexcept override {
    return {.resolution = 0.01 / 16, .revision = revision, .step = 1e-4};
  }
};

TEST(EyeContact, AHandFromBehindFeelsNothingAndIsHeldFromTheFront) {
  const SkinField skin;
  for (const double slow : {0.01, 0.1, 0.5}) {
    Proxy proxy;
    proxy.reset({0, 0, -0.03});
    double most = 0;
    const auto feel = [&](const Vector3d&, const Contact& c) {
      most = std::max(most, c.force.norm());
    };
    drive(proxy, skin, {0, 0, -0.03}, {0, 0, 0.01}, slow, feel);
    EXPECT_EQ(most, 0) << slow;
    EXPECT_NEAR(drive(proxy, skin, {0, 0, 0.01}, {0, 0, -2e-3}, slow).force.z(), 1, 1e-6) << slow;
  }
}

TEST(EyeContact, AHandThatTurnsRoundWithinTheSkinGoesBackFreely) {
  const SkinField skin;
  Proxy proxy;
  proxy.reset({0, 0, -0.03});
  double most = 0;
  const auto feel = [&](const Vector3d&, const Contact& c) {
    most = std::max(most, c.force.norm());
  };
  const Vector3d within(0, 0, -1e-3);
  drive(proxy, skin, {0, 0, -0.03}, within, 0.05, feel);
  for (int i = 0; i < 100; ++i) feel(within, proxy.step(skin, within, kTick));
  drive(proxy, skin, within, {3e-3, 0, -1.5e-3}, 0.05, feel);
  drive(proxy, skin, {3e-3, 0, -1.5e-3}, {0, 0, -0.03}, 0.05, feel);
  EXPECT_EQ(most, 0);
}

TEST(EyeContact, ASkinThatTurnsOverAndBackLeadsNobodyThroughItself) {
  const Vector3d hip(0, 0, -3e-3);
  for (const double angle : {1.0, 2.0, 3.0}) {
    SkinField skin;
    Proxy proxy;
    proxy.reset({0, 0, 0.02});
    drive(proxy, skin, {0, 0, 0.02}, hip, 0.1);
    constexpr int kTicks = 25;
    for (int i = 1; i <= 2 * kTicks; ++i) {
      const double a = angle * (1 - std::abs(i - kTicks) * 1.0 / kTicks);
      skin.normal = Vector3d(std::sin(a), 0, std::cos(a));
      ++skin.revision;
      (void)proxy.step(skin, hip, kTick);
    }
    const Contact after = rest(proxy, skin, hip, 10);
    EXPECT_TRUE(after.touching) << angle;
    EXPECT_GT(after.normal.z(), 0.99) << angle;
    EXPECT_GE(after.proxy.z(), -1e-6) << angle;
    // In free air in front nothing holds the hand.
    EXPECT_EQ(drive(proxy, skin, hip, {0, 0, 0.04}, 0.1).force.norm(), 0) << angle;
  }
}

}  // namespace
}  // namespace palpate::test
