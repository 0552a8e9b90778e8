#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "apps/palpate/record/recorder.hpp"
#include "apps/palpate/replay/replay.hpp"
#include "apps/palpate/run/run.hpp"
#include "apps/setup_parsed.hpp"
#include "palpate/base/clock.hpp"
#include "session/recording.hpp"

namespace palpate::app {
namespace {

// A device that is as stiff as it needs to be, and anywhere.
session::RecordedDevice handle() {
  DeviceInfo info;
  info.name = "handle";
  info.maximum_force = 8;
  info.damping = 2;
  info.delay = 1e-3;
  return session::RecordedDevice(info);
}

// 3 mm deep in the plane z = 0 and around a circle, and out of it at times.
DeviceState hand_at(int step) {
  DeviceState state;
  const double time = 1e-3 * step;
  state.time = time;
  state.position = {5e-3 * std::cos(7 * time), 5e-3 * std::sin(7 * time),
                    1e-3 - 4e-3 * std::sin(3 * time)};
  state.velocity = {-35e-3 * std::sin(7 * time), 35e-3 * std::cos(7 * time),
                    -12e-3 * std::cos(3 * time)};
  return state;
}

void change_settings(int step, Servo& servo) {
  if (step == 200) servo.set_contact({200, {0.3, 0.2, 0}, {}});
  if (step == 300) servo.set_field({.kind = FieldOptions::Kind::metaball});
  if (step == 400) servo.set_contact({350, {0.3, 0.2, 1}, {1e-4, 4e-3}});
  if (step == 500) servo.pause(true);
  if (step == 550) servo.pause(false);
  if (step == 600) servo.add_force({0.1, 1.0 / 3, 0});
  if (step == 700) servo.reset();
  if (step == 800) servo.set_field({});
}

TEST(Replay, ChangesOfSettingsInContactAreDoneAgainInTheirSteps) {
  Shell shell;
  shell.write("plane.xyz", plane_xyz());
  const TouchPlan plan = planned(shell.path("plane.xyz"));
  LoadedScene loaded = load_sources(plan.sources, {.keep_clouds = true});
  begin_run(loaded, {});
  Recorder recorder(shell.path("run.mcap"));
  session::RecordedDevice device = handle();
  ServoOptions options;
  options.traces = recorder.add_hand();
  Servo servo(device, loaded.scene, options);
  recorder.begin(loaded, {&servo}, 0, true);
  std::vector<Eigen::Vector3d> forces;
  for (int step = 0; step < 1200; ++step) {
    change_settings(step, servo);
    forces.push_back(servo.step(hand_at(step), 5 + 1e-3 * step).force);
    servo.show();
    recorder.keep_up();
  }
  const RecordReport report = recorder.finish().at(0);
  EXPECT_EQ(report.steps, 1200u);
  EXPECT_EQ(report.problem, "");
  const auto felt = std::ranges::count_if(forces, [](const auto& f) { return f.norm() > 0.05; });
  EXPECT_GT(felt, 300);
  std::vector<Eigen::Vector3d> again;
  const ForceDifference difference =
      Replay(shell.path("run.mcap")).run(0, [&](const ServoState& step, const DeviceInfo&) {
        again.push_back(step.force);
      });
  EXPECT_TRUE(difference.exact()) << "step " << difference.first << " " << difference.ended;
  EXPECT_EQ(again, forces);
}

// A point and its normal.
std::pair<Eigen::Vector3d, Eigen::Vector3d> middle_of(const SurfacePoints& points) {
  std::size_t i = points.size() / 2;
  while (points.normals[i].norm() < 0.5F) ++i;
  return {points.origin + points.grid.points()[i].cast<double>(), points.normals[i].cast<double>()};
}

// The hand goes to and fro through what the camera sees.
TEST(Replay, ChangesOfPreparationAreDoneAgainBeforeTheirFrames) {
  Shell shell;
  const TouchPlan plan = planned("camera:simulated --simulated-time");
  LoadedScene loaded = load_sources(plan.sources, {});
  begin_run(loaded, {});
  LoadedSource& from = loaded.sources.front();
  Source& source = loaded.scene.source(0);
  Recorder recorder(shell.path("run.mcap"));
  const Stream::Sink push = recorder.watching(0, feeding(from, source, thread_cpu_seconds));
  const std::function<void()> end = recorder.watching(0, [&] { source.keep(); });
  session::RecordedDevice device = handle();
  ServoOptions options;
  options.guard.on = false;
  options.traces = recorder.add_hand();
  Servo servo(device, loaded.scene, options);
  recorder.begin(loaded, {&servo}, 0, true);
  DepthFrame frame;
  std::pair<Eigen::Vector3d, Eigen::Vector3d> place;
  double largest = 0;
  for (int step = 0; step < 800; ++step) {
    const double now = 1e-3 * step;
    if (step % 33 == 0 && step < 600) {
      ASSERT_EQ(from.camera->read(frame, 1), DepthCamera::Status::frame);
      if (step == 198 || step == 297) {
        SourceOptions changed = source.options();
        changed.depth.normal_error *= step == 198 ? 2 : 0.5;
        changed.policy.policy = step == 198 ? Policy::crossfade : Policy::morph;
        source.change(changed);
      }
      push(frame, [&] { return now + 5e-3; });
    }
    if (step == 600) end();
    DeviceState hand;
    if (step == 0) place = middle_of(*source.points());
    hand.position = place.first + 0.03 * std::cos(10 * now) * place.second;
    largest = std::max(largest, servo.step(hand, now).force.norm());
    servo.show();
    recorder.keep_up();
  }
  EXPECT_EQ(recorder.finish().at(0).frames, 19u);
  EXPECT_GT(largest, 0.05);
  const ForceDifference difference =
      Replay(shell.path("run.mcap")).run(0, [](const ServoState&, const DeviceInfo&) {});
  EXPECT_TRUE(difference.exact()) << "step " << difference.first << " " << difference.ended;
  EXPECT_EQ(difference.steps, 800u);
}

TEST(Replay, StepsThatFindNoRoomAreCounted) {
  StepTraces steps(2);
  ServoState state;
  for (state.step = 1; state.step <= 3; ++state.step) steps.push({state, {}});
  EXPECT_EQ(steps.dropped(), 1u);
  ASSERT_NE(steps.front(), nullptr);
  EXPECT_EQ(steps.front()->state.step, 1u);
  steps.drop();
  EXPECT_EQ(steps.front()->state.step, 2u);
  steps.drop();
  EXPECT_EQ(steps.front(), nullptr);
}

}  // namespace
}  // namespace palpate::app
