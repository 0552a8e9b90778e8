// Presses by mouse from place to place: what a page says, hand, device, field, proxy and guard
// together.
#include "session/led_hand.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/numbers.hpp"
#include "palpate/device/exploration.hpp"
#include "palpate/device/simulated.hpp"
#include "palpate/io/synthetic.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/servo/servo.hpp"
#include "palpate/tool/tool.hpp"
#include "session/page_hand.hpp"
#include "support/effort.hpp"

namespace palpate::session {
namespace {

using Eigen::Vector3d;

// A place that the page's eye sees.
struct Place {
  Vector3d position, normal;
  double reach = 0;  // of the pick, m
};

// Where a page looks from above a corner, and what it sees.
struct Look {
  explicit Look(const PointCloud& the_cloud, double the_spacing)
      : cloud(the_cloud), reach(1.5 * the_spacing) {
    Vector3d lower = Vector3d::Constant(std::numeric_limits<double>::infinity());
    Vector3d upper = -lower;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      lower = lower.cwiseMin(cloud.point(i));
      upper = upper.cwiseMax(cloud.point(i));
    }
    eye = 0.5 * (lower + upper) +
          1.1 * (upper - lower).norm() * Vector3d(-0.6, -0.55, 0.58).normalized();
  }

  // A place at random that no point hides.
  [[nodiscard]] Place any(Random& random) const {
    while (true) {
      const auto k = static_cast<std::size_t>(random.uniform() * static_cast<double>(cloud.size()));
      const Place place{cloud.point(k), cloud.normals[k].cast<double>(), reach};
      const Vector3d sight = place.position - eye;
      if (place.normal.dot(sight) < -0.3 * sight.norm() && sees(sight)) return place;
    }
  }

  [[nodiscard]] bool sees(const Vector3d& sight) const {
    const double length = sight.norm();
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Vector3d offset = cloud.point(i) - eye;
      const double along = offset.dot(sight) / length;
      const double aside = offset.squaredNorm() - along * along;
      if (along < length - 4 * reach && aside < reach * reach) return false;
    }
    return true;
  }

  const PointCloud& cloud;
  double reach;
  Vector3d eye;
};

// A page that presses with 1 N, as its stroke.ts does, and what the hand feels.
struct Pressing {
  Pressing(const PointCloud& cloud, Scene& the_scene)
      : scene(the_scene),
        placement(place_device(scene, {}, {})),
        look(cloud, scene.source(0).report().spacing),
        servo(device, scene, options(placement)),
        led(remote, placement.workspace, scene) {}

  static ServoOptions options(const Placement& placement) {
    ServoOptions options;
    options.proxy.stiffness = placement.stiffness;
    set_for_pages(options);
    options.guard.silence = std::numeric_limits<double>::infinity();
    options.workspace = placement.workspace;
    return options;
  }

  // Says where the hand is wanted, and lets 16 ms pass.
  void say(const TargetSource::Target& target, const std::optional<Vector3d>& eye) {
    led.move(target, eye, servo, 1e-3 * static_cast<double>(step));
    for (int i = 0; i < 16; ++i, ++step) {
      const Vector3d force = servo.tick().force;
      largest = std::max(largest, force.norm());
      jump = std::max(jump, (force - last).norm());
      last = force;
    }
  }

  // Does a press there come to its force within 15 s?
  bool press(const Place& place) {
    const Vector3d above = place.position + 2 * place.reach * place.normal;
    const Vector3d below = place.position - 3 * place.reach * place.normal;
    const std::size_t begin = step;
    while (step < begin + 15'000 && (servo.state().hip - above).norm() > place.reach) {
      say({.position = above}, look.eye);
    }
    bool pressed = false;
    for (const std::size_t end = step + 1500; step < end;) {
      const bool touching = servo.state().contact.touching;
      say({.position = below, .maximum_force = 1},
          touching ? std::nullopt : std::optional(look.eye));
      pressed = pressed || (touching && last.norm() > 0.9);
    }
    for (int i = 0; i < 6; ++i) say({.position = above}, look.eye);
    return pressed;
  }

  Scene& scene;
  Placement placement;
  Look look;
  RemoteTarget remote;
  TeleoperatedHand guide{remote, {}, {.speed = kReachingSpeed}};
  SimulatedDevice device{{}, guide};
  Servo servo;
  LedHand led;
  std::size_t step = 0;
  Vector3d last = Vector3d::Zero();  // N
  double largest = 0;                // N
  double jump = 0;                   // N in a step
};

// Straight there at 2 m/s, 11 N were felt in the room and 14 N at the table, and 8 N went in a
// step.
TEST(LedHand, PressesFromPlaceToPlaceAndTouchesNothingBetween) {
  for (const char* name : {"table", "room", "rabbit"}) {
    const PointCloud cloud = synthetic_cloud(name);
    Scene scene;
    scene.add(name, cloud);
    Pressing page(cloud, scene);
    Random random(7);
    const int presses = test::effort(34);
    int pressed = 0;
    for (int i = 0; i < presses; ++i) pressed += page.press(page.look.any(random)) ? 1 : 0;
    EXPECT_GE(pressed, 0.9 * presses) << name;
    EXPECT_LT(page.largest, 1.2) << name;
    EXPECT_LT(page.jump, 0.5) << name;
  }
}

// A hand in a closed box, which no way leaves.
TEST(LedHand, WhereNoWayIsFreeItPushesNoHarderThanHalfANewton) {
  const PointCloud cloud = synthetic_cloud("room");
  Scene scene;
  scene.add("room", cloud);
  Pressing page(cloud, scene);  // begins below the table, whose walls reach the floor
  double farthest = 0;
  for (int i = 0; i < 200; ++i) {
    page.say({.position = {1.9, 1.4, 2}}, page.look.eye);
    farthest = std::max(farthest, page.device.true_velocity().norm());
  }
  EXPECT_LT(page.largest, 1.2);
  EXPECT_LT(farthest, 0.2);
}

// So small a move of the pointer begins no new way.
TEST(LedHand, FollowsAGoalThatMovesAfterItHasArrived) {
  const PointCloud cloud = synthetic_cloud("table");
  Scene scene;
  scene.add("table", cloud);
  Pressing page(cloud, scene);
  Random random(7);
  const Place place = page.look.any(random);
  const Vector3d above = place.position + 2 * place.reach * place.normal;
  const double aside = 0.4 * scene.source(0).points()->radius;
  const Vector3d beside = above + aside * place.normal.unitOrthogonal();
  for (int i = 0; i < 600; ++i) page.say({.position = above}, page.look.eye);
  ASSERT_LT((page.servo.state().hip - above).norm(), 0.2 * aside);
  const std::uint64_t ways = page.remote.command()->ways;
  for (int i = 0; i < 60; ++i) page.say({.position = beside}, page.look.eye);
  EXPECT_EQ(page.remote.command()->ways, ways);
  EXPECT_LT((page.servo.state().hip - beside).norm(), 0.2 * aside);
}

// A device that reports no number.
class Broken final : public Device {
 public:
  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] DeviceState read() noexcept override {
    DeviceState state;
    state.time = 1e-3 * ++steps_;
    state.position.x() = std::nan("");
    return state;
  }
  void write(const Vector3d&) noexcept override {}
  [[nodiscard]] std::string reason() const override { return {}; }

 private:
  DeviceInfo info_;
  int steps_ = 0;
};

TEST(LedHand, PlansNoWayFromNowhere) {
  Scene scene;
  scene.add("table", synthetic_cloud("table"));
  RemoteTarget remote;
  const Workspace workspace;
  LedHand led(remote, workspace, scene);
  Broken device;
  Servo servo(device, scene);
  servo.tick();
  ASSERT_FALSE(servo.state().hip.allFinite());
  led.move({.position = {0, 0.3, 2}}, Vector3d(0, 0, 9), servo, 0);
  ASSERT_TRUE(remote.command());
  EXPECT_EQ(remote.command()->moves, 1u);
  EXPECT_EQ(remote.command()->way.size, 1u);
  EXPECT_EQ(remote.command()->target.maximum_force, 0.5);
}

// Ways are looked at for a point: what the tool's body meets on them is not known.
TEST(LedHand, PushesABodyNoHarderThanHalfANewton) {
  Scene scene;
  scene.add("table", synthetic_cloud("table"));
  RemoteTarget remote;
  const Workspace workspace;
  LedHand led(remote, workspace, scene);
  TeleoperatedHand guide(remote);
  SimulatedDevice device({.position = {0, 0, 2}}, guide);
  for (const bool body : {false, true}) {
    ServoOptions options;
    if (body) options.tool = std::make_shared<const Tool>(Tool::from_text("box:20x20x20", 4e-3));
    Servo servo(device, scene, options);
    servo.tick();
    led.release();
    led.move({.position = {0, 0.3, 2}}, Vector3d(0, 0, 9), servo, body ? 1 : 0);
    EXPECT_EQ(remote.command()->target.maximum_force, body ? 0.5 : 4);
    EXPECT_LE(remote.command()->way.speed, body ? 0.1 : 1);
  }
}

TEST(LedHand, IsFollowedAtOnceWhereThePageNamesNoEye) {
  Scene scene;
  scene.add("nothing yet");
  RemoteTarget remote;
  const Workspace workspace;
  LedHand led(remote, workspace, scene);
  TeleoperatedHand guide(remote);
  SimulatedDevice device({}, guide);
  const Servo servo(device, scene);
  led.move({.position = {1, 2, 3}}, std::nullopt, servo, 0);
  EXPECT_EQ(remote.command()->way.size, 0u);
  EXPECT_EQ(remote.command()->target.position, Vector3d(1, 2, 3));
  led.move({.position = {1, 2, 4}}, Vector3d(0, 0, 9), servo, 0.016);
  EXPECT_EQ(remote.command()->way.size, 1u) << "nothing is there: straight";
  EXPECT_EQ(remote.command()->target.position, Vector3d(1, 2, 4));
  led.release();
  EXPECT_FALSE(remote.command()->held);
}

}  // namespace
}  // namespace palpate::session
