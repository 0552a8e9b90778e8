#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "contact/spring.hpp"
#include "contact/test_fields.hpp"

namespace palpate {
namespace {

TEST(EnergyTank, ConstantStiffnessStaysBitForBit) {
  EnergyTank tank;
  tank.restart(437.123);
  for (int i = 0; i < 1000; ++i) {
    EXPECT_EQ(tank.follow(437.123, 1e-3 * (i % 7), 1e-5, 1e-3), 437.123);
  }
}

TEST(EnergyTank, EmptyTankPaysForNoRise) {
  EnergyTank tank;
  tank.restart(100);
  EXPECT_EQ(tank.follow(500, 2e-3, 0, 1e-3), 100);
}

TEST(EnergyTank, RiseIsFreeWhereTheSpringIsSlack) {
  EnergyTank tank;
  tank.restart(100);
  for (int i = 0; i < 20; ++i) tank.follow(500, 0, 0, 1e-3);
  EXPECT_EQ(tank.stiffness(), 500);
}

TEST(EnergyTank, FallGoesByTheClockAndFillsTheTank) {
  EnergyTank tank;
  tank.restart(500);
  const double after = tank.follow(0, 3e-3, 0, 1e-3);
  EXPECT_DOUBLE_EQ(after, 500 * std::exp(-0.05));
  EXPECT_DOUBLE_EQ(tank.energy(), 0.5 * (500 - after) * 9e-6);
  EXPECT_EQ(tank.follow(0.99 * after, 3e-3, 0, 1e-3), 0.99 * after);
}

TEST(EnergyTank, GivesByTheClockUpToWhatIsWanted) {
  EnergyTank tank;
  tank.restart(100);
  tank.give(500, 0.1);
  EXPECT_DOUBLE_EQ(tank.stiffness(), 150);
  for (int i = 0; i < 10; ++i) tank.give(500, 0.1);
  EXPECT_EQ(tank.stiffness(), 500);
  tank.give(400, 0.1);
  EXPECT_EQ(tank.stiffness(), 500) << "a fall is not its matter";
}

class FadedSheet final : public Field {
 public:
  FadedSheet() { sheet_.thickness = 1; }
  double presence = 1;
  double stiffness_factor = 1;

  [[nodiscard]] Sample sample(const Eigen::Vector3d& x) const noexcept override {
    return sheet_.sample(x);
  }
  [[nodiscard]] bool is_free(const Ball& ball) const noexcept override {
    return sheet_.is_free(ball);
  }
  [[nodiscard]] Surface surface(const Eigen::Vector3d&) const noexcept override {
    return {.stiffness_factor = stiffness_factor, .presence = presence, .source = 0};
  }
  [[nodiscard]] Field::Traits traits() const noexcept override { return sheet_.traits(); }

 private:
  test::SheetField sheet_;
};

// A mass of 0.1 kg is pressed by 1 N onto a surface whose stiffness falls to 2 % for a second and
// comes back: the largest depth, m; the depth and the stiffness, N/m, half a second later.
struct Pressed {
  double deepest, depth, stiffness;
};
Pressed pressed_while_it_was_soft(double rise_time) {
  FadedSheet sheet;
  Proxy proxy({.rise_time = rise_time});
  double z = 1e-3;
  double speed = 0;
  double deepest = 0;
  double stiffness = 0;
  for (int i = 0; i < 2000; ++i) {
    sheet.stiffness_factor = i > 500 && i <= 1500 ? 0.02 : 1;
    const Contact contact = proxy.step(sheet, {0, 0, z}, 1e-3);
    stiffness = contact.stiffness;
    speed += 1e-3 / 0.1 * (contact.force.z() - 1 - 3 * speed);
    z += 1e-3 * speed;
    deepest = std::max(deepest, -z);
  }
  return {deepest, -z, stiffness};
}

TEST(EnergyTank, AHandThatNoMotorMovesComesOutOfWhatWasSoftByTheClock) {
  const Pressed paid = pressed_while_it_was_soft(std::numeric_limits<double>::infinity());
  EXPECT_LT(paid.stiffness, 100) << "nothing pays: the case is there";
  EXPECT_GT(paid.depth, 0.02);
  const Pressed given = pressed_while_it_was_soft(0.3);
  EXPECT_GT(given.deepest, 0.02) << "it was soft";
  EXPECT_GE(given.stiffness, 450);
  EXPECT_NEAR(given.depth, 1.0 / 500, 5e-4);
}

TEST(EnergyTank, AHandThatNoMotorMovesFeelsAFadingSurfaceWholeUntilItIsGone) {
  FadedSheet sheet;
  Proxy proxy({.rise_time = 0.3});
  const auto force = [&](double z) { return proxy.step(sheet, {0, 0, z}, 1e-3).force.z(); };
  EXPECT_EQ(force(1e-3), 0);
  for (int i = 0; i < 400; ++i) force(-2e-3);  // comes to its stiffness
  for (sheet.presence = 1; sheet.presence > 0.012; sheet.presence -= 2e-3)
    EXPECT_NEAR(force(-2e-3), 1, 1e-9) << sheet.presence;
  sheet.presence = 0.005;
  for (int i = 0; i < 200; ++i) force(-2e-3);  // falls with a time constant of 20 ms
  EXPECT_LT(force(-2e-3), 0.01);
}

TEST(EnergyTank, FrictionPaysForARise) {
  EnergyTank tank;
  tank.restart(100);
  // A rise of 2 N/m at 2 mm costs 4e-6 J.
  EXPECT_NEAR(tank.follow(500, 2e-3, 4e-6, 1e-3), 102, 1e-12);
  EXPECT_NEAR(tank.energy(), 0, 1e-18);
}

TEST(EnergyTank, KeepsNoMoreThanItsCapacity) {
  EnergyTank tank;
  tank.restart(500);
  tank.follow(500, 0, 1.0, 1e-3);
  EXPECT_EQ(tank.energy(), EnergyTank::kCapacity);
}

TEST(EnergyTank, NeverCreatesEnergyWhateverTheStiffnessDoes) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0, 1);
  EnergyTank tank;
  tank.restart(300);
  double created = 0;  // by changes of K
  double dissipated = 0;
  for (int i = 0; i < 100000; ++i) {
    const double before = tank.stiffness();
    const double stretch = 5e-3 * uniform(random);
    const double lost = 1e-6 * uniform(random) * (i % 3 == 0 ? 1 : 0);
    const double wanted = 600 * uniform(random);
    const double after = tank.follow(wanted, stretch, lost, 1e-3);
    created += 0.5 * (after - before) * stretch * stretch;
    dissipated += lost;
    ASSERT_LE(after, std::max(before, wanted));
    ASSERT_GE(after, 0);
    ASSERT_GE(tank.energy(), 0);
    ASSERT_LE(created, dissipated + 1e-12);
  }
}

// A hand in a world of kilometres has a spring of thousandths of a newton a metre.
TEST(FadingSpring, FadesAlikeInWorldsOfAnyScale) {
  for (const double stiffness : {5e-4, 500.0, 5e5}) {
    FadingSpring spring;
    spring.take({0, 0, 3}, stiffness);
    double given_up = 0;
    for (int i = 1; i <= 20; ++i) {
      given_up += spring.fade(Eigen::Vector3d::Zero(), 1e-3);
      EXPECT_NEAR(spring.force(Eigen::Vector3d::Zero()).z(),
                  3 * stiffness * std::exp(-1e-3 * i / EnergyTank::kTime), 1e-9 * stiffness);
    }
    for (int i = 0; i < 200; ++i) given_up += spring.fade(Eigen::Vector3d::Zero(), 1e-3);
    EXPECT_EQ(spring.stiffness(), 0);
    EXPECT_NEAR(given_up, 0.5 * stiffness * 9, 0.003 * stiffness * 9);
  }
}

TEST(FadingSpring, TwoPullLikeBoth) {
  FadingSpring spring;
  spring.take({0, 0, 1}, 300);
  spring.take({1, 0, 0}, 100);
  const Eigen::Vector3d hip(0.2, -0.5, 0.1);
  const Eigen::Vector3d both =
      300 * (Eigen::Vector3d(0, 0, 1) - hip) + 100 * (Eigen::Vector3d(1, 0, 0) - hip);
  EXPECT_LT((spring.force(hip) - both).norm(), 1e-9);
}

}  // namespace
}  // namespace palpate
