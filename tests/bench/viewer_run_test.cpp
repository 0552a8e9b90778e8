#include "viewer/viewer_run.hpp"

#include <gtest/gtest.h>

#include "servo_cost/paced_servo.hpp"

namespace palpate::viewer_bench {
namespace {

constexpr std::size_t kPoints = 3000;
constexpr double kSeconds = 2;

RunResult run(Beside beside) {
  SteadyClock clock;
  Scene scene;
  add_cloud(scene, kPoints);
  return run_servo(scene, servo_cost::hand_over(scene, kSeconds), beside, clock, {});
}

TEST(ViewerRun, WithoutAViewerTheServoIsAlone) {
  const RunResult alone = run({});
  EXPECT_GT(alone.servo.computing.size(), 0u);
  EXPECT_GT(alone.servo.touching, 0u);
  EXPECT_TRUE(alone.clients.empty());
}

TEST(ViewerRun, EveryClientThatReadsGetsEveryPoint) {
  const RunResult seen = run({.clients = true, .renewed = false});
  ASSERT_EQ(seen.clients.size(), static_cast<std::size_t>(kClients - 1));
  for (const ClientReport& client : seen.clients) {
    EXPECT_GE(client.points, kPoints);  // points that lie on two sheets are there twice
    EXPECT_LT(client.points, kPoints + kPoints / 100);
    EXPECT_EQ(client.clouds, 1u);
    EXPECT_GT(client.bytes, 8 * kPoints);
  }
}

}  // namespace
}  // namespace palpate::viewer_bench
