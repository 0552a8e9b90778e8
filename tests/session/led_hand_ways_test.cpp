// Which ways a led hand takes as free.
#include <gtest/gtest.h>

#include <string>

#include "palpate/device/simulated.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/servo/servo.hpp"
#include "session/led_hand.hpp"

namespace palpate::session {
namespace {

using Eigen::Vector3d;

// A strip of 5 rows of points with that spacing, m, in the plane z = 0, that begins at x.
PointCloud strip(double spacing, double x, int columns) {
  PointCloud cloud;
  for (int i = 0; i < columns; ++i) {
    for (int j = -2; j <= 2; ++j) {
      cloud.positions.emplace_back(static_cast<float>(x + spacing * i),
                                   static_cast<float>(spacing * j), 0.0F);
    }
  }
  return cloud;
}

// What a hand at rest 20 mm above a strip from x = 0 on, which has 4 mm between its points, may
// pull with on its way so far along it, m; N.
double pull_along(Scene& scene, double way) {
  RemoteTarget remote;
  const Workspace workspace;
  LedHand led(remote, workspace, scene);
  TeleoperatedHand guide(remote);
  SimulatedDevice device({.position = {0, 0, 0.02}}, guide);
  Servo servo(device, scene);
  servo.tick();
  led.move({.position = {way, 0, 0.02}}, Vector3d(0, 0, 1), servo, 0);
  return remote.command()->target.maximum_force;
}

// With the largest R of all sources for each of them, no way beside the fine one was free.
TEST(LedHand, KeepsClearOfEachPointByTheRadiusOfThatPoint) {
  Scene scene;
  scene.add("fine", strip(4e-3, 0, 20));
  scene.add("coarse", strip(0.2, 3, 5));
  ASSERT_GT(scene.source(1).points()->radius, 10 * scene.source(0).points()->radius);
  EXPECT_EQ(pull_along(scene, 0.03), 4);
}

// Each look of a plan is one search in each source, and 2000 searches are the most.
TEST(LedHand, TakesNoWayAsFreeThatWouldBeLookedAtForTooLong) {
  Scene scene;
  scene.add("fine", strip(4e-3, 0, 1000));
  EXPECT_EQ(pull_along(scene, 4), 4);
  for (int i = 1; i < 8; ++i) scene.add("far " + std::to_string(i), strip(4e-3, 9 + i, 5));
  EXPECT_EQ(pull_along(scene, 0.03), 4);
  EXPECT_EQ(pull_along(scene, 4), 0.5);
}

// It pulled with 4 N there, and was held in a surface between its points by that.
TEST(LedHand, PullsNoHarderThanHalfANewtonWhereItTouchesOnItsWay) {
  Scene scene;
  scene.add("fine", strip(4e-3, 0, 20));
  RemoteTarget remote;
  const Workspace workspace;
  LedHand led(remote, workspace, scene);
  TeleoperatedHand guide(remote);
  SimulatedDevice device({.position = {0, 0, 0.02}}, guide);
  Servo servo(device, scene);
  servo.tick();
  const TargetSource::Target beyond{.position = {0, 0, -0.02}};
  remote.move(beyond, 0);
  for (int i = 0; i < 500 && !servo.state().contact.touching; ++i) servo.tick();
  ASSERT_TRUE(servo.state().contact.touching);
  led.move({.position = {0, 0, 0.03}}, Vector3d(0, 0, 1), servo, 1);
  EXPECT_EQ(remote.command()->target.maximum_force, 0.5);
}

}  // namespace
}  // namespace palpate::session
