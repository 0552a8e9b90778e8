// Rows of things that move, come, jump, hide and fall silent before a robot's cameras.
#include <algorithm>
#include <numbers>

#include "robot/trial.hpp"

namespace palpate::robot {
namespace {

using Eigen::Vector3d;

void comes_on(Trial& trial) {
  const double speed = trial.one_of({0.02, 0.1, 0.25, 0.5, 1});
  trial.moves(trial.floor(), speed * kUp, kHappens,
              std::min(trial.between(0.05, 0.25) / speed, 4.));
  trial.hand();
}

// A wall comes or goes slowly, as what lies on a belt or breathes does: the robot is to follow.
void comes_slowly(Trial& trial) {
  const double speed = trial.one_of({-0.02, -0.005, 0.002, 0.005, 0.01, 0.02, 0.03});
  trial.moves(trial.floor(), speed * kUp, 1, kEnd - 1);
  trial.hand();
}

void to_and_fro(Trial& trial) {
  const double speed = trial.between(0.05, 1);
  trial.floor().motion.swing = trial.between(0.02, 0.1) * kUp;
  trial.floor().motion.frequency =
      speed / (2 * std::numbers::pi * trial.floor().motion.swing.norm());
  trial.hand();
}

void jumps(Trial& trial) {
  trial.moves(trial.floor(), trial.between(0.005, 0.1) / 1e-6 * kUp, kHappens, 1e-6);
  trial.hand();
}

void plate_appears(Trial& trial) {
  trial.hand();
  const double thick = trial.between(0.005, 0.05);
  const Vector3d at = trial.hand_then();
  SimulatedSolid& plate = trial.add(
      SolidKind::block, {at.x(), at.y(), std::max(at.z(), 0.) + trial.between(-0.01, 0.04)},
      {0.1, 0.1, thick / 2});
  trial.comes(plate, kHappens);
}

// Something is laid between the camera and the tool; for one frame, nothing is measured.
void laid_over(Trial& trial) {
  trial.hand();
  const Vector3d at = trial.hand_then();
  const double above = std::max(at.z(), 0.) + trial.between(0.01, 0.06);
  SimulatedSolid& thing =
      trial.add(SolidKind::block, {at.x(), at.y(), above + 0.015}, {0.08, 0.08, 0.015});
  trial.comes(thing, kHappens);
  const double shadow = trial.one_of({0, 1}) / trial.cameras.front().options.rate;
  trial.cameras.front().fault = [=](DepthFrame& frame) {
    if (frame.stamp > kHappens && frame.stamp < kHappens + shadow)
      std::ranges::fill(frame.depth, 0.0f);
    return true;
  };
}

void ball_comes(Trial& trial) {
  trial.hand();
  const Vector3d at = trial.hand_then();
  const Vector3d way = (trial.level_direction() + trial.between(-0.5, 1) * kUp).normalized();
  const double speed = trial.between(0.05, 1);
  const Vector3d goal(at.x(), at.y(), std::max(at.z(), 0.));
  SimulatedSolid& ball = trial.add(SolidKind::ball, goal - 0.3 * way, {0.06, 0.06, 0.06});
  trial.moves(ball, speed * way, kHappens, std::min(trial.between(0.2, 0.5) / speed, 4.));
}

void box_slides(Trial& trial) {
  trial.hand();
  const Vector3d at = trial.hand_then();
  const Vector3d way = trial.level_direction();
  const double speed = trial.between(0.05, 1);
  SimulatedSolid& box =
      trial.add(SolidKind::block, Vector3d(at.x(), at.y(), 0.04) - 0.35 * way, {0.05, 0.05, 0.04});
  trial.moves(box, speed * way, kHappens, trial.between(0.25, 0.6) / speed);
}

// Something passes between the camera and the hand.
void passes_before(Trial& trial) {
  trial.hand();
  const Vector3d eye = trial.cameras.front().options.T_world_camera.translation();
  const Vector3d way = trial.level_direction();
  const double speed = trial.between(0.1, 0.5);
  SimulatedSolid& arm = trial.add(SolidKind::block, 0.5 * eye - 0.5 * way, {0.06, 0.06, 0.03});
  trial.moves(arm, speed * way, kHappens, 1 / speed);
}

void hole(Trial& trial) {
  const double speed = trial.one_of({0, 0.05, 0.25});
  trial.moves(trial.floor(), speed * kUp, kHappens + 0.2, speed > 0 ? 0.1 / speed : 0.);
  trial.hand();
  trial.hole(trial.cameras.front(), kHappens, trial.between(0.3, 3));
}

void one_of_two_is_silent(Trial& trial) {
  trial.camera().fault = [](DepthFrame& frame) { return frame.stamp < kHappens; };
  trial.floor_rises(trial.between(0.02, 0.3), 0.1, kHappens + 0.5);
  trial.hand();
}

void two_cameras(Trial& trial) {
  trial.camera();
  trial.floor_rises(trial.between(0.05, 0.5), 0.15);
  trial.hand();
}

void begins_behind(Trial& trial) {
  trial.hand();
  const double depth = trial.between(0.01, 0.05);
  for (std::size_t i = 0; i < 2500; ++i) trial.hip[i] = {0, 0, -depth};
}

void frames_are_lost(Trial& trial) {
  trial.cameras.front().options.dropped = 0.4;
  trial.floor_rises(trial.between(0.05, 0.5), 0.15);
  trial.hand();
}

void with_size(Trial& trial) {
  trial.seed % 2 == 0 ? comes_on(trial) : ball_comes(trial);
  trial.tool_radius = 0.004;
}

// Everything stands still, and the hand presses, slides and is lifted in front of it.
void rests(Trial& trial) {
  trial.cameras.front().options.dropped = 0;
  const Vector3d aside = 0.12 * trial.level_direction();
  trial.add(SolidKind::ball, aside, {0.05, 0.05, 0.05});
  trial.add(SolidKind::block, -aside, {0.04, 0.04, 0.03});
  trial.hand();
}

void rests_under_two(Trial& trial) {
  rests(trial);
  Trial other(trial.seed + 1000003);
  rests(other);
  trial.cameras.push_back(other.cameras.front());
}

// The hand stays in front of it, and frames are lost.
void rests_with_losses(Trial& trial, double lost) {
  rests(trial);
  trial.cameras.front().options.dropped = lost;
  for (Eigen::Vector3d& place : trial.hip) place = {0, 0, 0.05};
}

void rests_with_size(Trial& trial) {
  rests(trial);
  trial.tool_radius = 0.004;
}

}  // namespace

std::vector<Row> all_rows() {
  return {{"plane comes", comes_on},
          {"plane comes slowly", comes_slowly},
          {"plane to and fro", to_and_fro},
          {"plane jumps", jumps},
          {"plate appears", plate_appears},
          {"something is laid over", laid_over},
          {"ball comes", ball_comes},
          {"box slides by", box_slides},
          {"something passes before", passes_before},
          {"hole", hole},
          {"one of two is silent", one_of_two_is_silent},
          {"two cameras", two_cameras},
          {"begins behind", begins_behind},
          {"frames are lost", frames_are_lost},
          {"tool with size", with_size},
          {"at rest", rests},
          {"at rest, two cameras", rests_under_two},
          {"at rest, tool with size", rests_with_size},
          {"at rest, none lost", [](Trial& trial) { rests_with_losses(trial, 0); }},
          {"at rest, a tenth lost", [](Trial& trial) { rests_with_losses(trial, 0.1); }},
          {"at rest, a third lost", [](Trial& trial) { rests_with_losses(trial, 1. / 3); }}};
}

}  // namespace palpate::robot
