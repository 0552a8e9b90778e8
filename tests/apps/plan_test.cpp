#include <gtest/gtest.h>

#include "apps/program.hpp"
#include "apps/setup_parsed.hpp"

namespace palpate::app {
namespace {

constexpr const char* kEverything = R"([[source]]
from = "camera:simulated"
memory = 3
[[source]]
name = "other"
from = "camera:simulated"
fit_everywhere = false
normal_error = 0.005
[[source]]
name = "points"
from = "camera:simulated"
unorganised = true

[reading]
viewpoint = [0, 0, 1.2]
unorganised = false

[stream]
silence = 0.7
fade = 0.9
nearest = 0.4
farthest = 2
memory = 12
fit_everywhere = true
clip_to_reach = true

[surface]
normal_error = 0.01
sharp_edges = false

[guard]
maximum_force = 2.5
slew = 150
watchdog = 0.02
damping = 0.7
soft_start = 0.1
passivity = false

[servo]
processor = 1
realtime = false
priority = 60
lock_memory = false
)";

TEST(SetupFile, EveryChoiceReachesTheLibrary) {
  const Shell shell;
  const TouchPlan plan = planned(shell, kEverything, "");
  ASSERT_EQ(plan.sources.size(), 3u);
  EXPECT_FALSE(plan.sources[0].as_cloud);
  EXPECT_TRUE(plan.sources[2].as_cloud);
  EXPECT_FALSE(plan.sources[2].options.organised);
  const SourceOptions& first = plan.sources[0].options;
  EXPECT_EQ(first.policy.silence, 0.7);
  EXPECT_EQ(first.policy.fade, 0.9);
  EXPECT_TRUE(first.policy.fit_everywhere);
  EXPECT_TRUE(first.policy.clip_to_reach);
  EXPECT_EQ(first.depth.nearest, 0.4);
  EXPECT_EQ(first.depth.farthest, 2);
  EXPECT_EQ(first.depth.memory, 3) << "its own";
  EXPECT_EQ(first.depth.normal_error, 0.01);
  EXPECT_EQ(first.prepare.normal_error, 0.01);
  ASSERT_TRUE(first.prepare.viewpoint);
  EXPECT_EQ(first.prepare.viewpoint->z(), 1.2);
  const SourceOptions& second = plan.sources[1].options;
  EXPECT_EQ(second.depth.memory, 12) << "of [stream]";
  EXPECT_FALSE(second.policy.fit_everywhere);
  EXPECT_EQ(second.depth.normal_error, 0.005);
  EXPECT_FALSE(plan.surface.field.sharp_edges);
  const GuardOptions& guard = plan.time.guard;
  EXPECT_EQ(guard.maximum_force, 2.5);
  EXPECT_EQ(guard.slew, 150);
  EXPECT_EQ(guard.silence, 0.02);
  EXPECT_EQ(guard.damping, 0.7);
  EXPECT_EQ(guard.soft_start, 0.1);
  EXPECT_FALSE(guard.passivity.on);
  const RealtimeOptions& realtime = plan.time.realtime;
  EXPECT_EQ(realtime.processor, 1);
  EXPECT_FALSE(realtime.realtime_priority);
  EXPECT_EQ(realtime.priority, 60);
  EXPECT_FALSE(realtime.lock_memory);
}

}  // namespace
}  // namespace palpate::app
