// What moves, comes, jumps, hides and falls silent before a robot's cameras.

#include "robot/draft.hpp"

namespace palpate::robot {
namespace {

using Eigen::Vector3d;

Trial comes_on(std::uint64_t seed) {
  Draft draft(seed);
  const double speed = draft.one_of({0.02, 0.1, 0.25, 0.5, 1});
  draft.moves(draft.floor(), speed * kUp, kHappens,
              std::min(draft.between(0.05, 0.25) / speed, 4.));
  draft.hand();
  return draft.trial;
}

// A wall comes or goes slowly, as what lies on a belt or breathes does: the robot is to follow.
Trial comes_slowly(std::uint64_t seed) {
  Draft draft(seed);
  const double speed = draft.one_of({-0.02, -0.005, 0.002, 0.005, 0.01, 0.02, 0.03});
  draft.moves(draft.floor(), speed * kUp, 1, kEnd - 1);
  draft.hand();
  return draft.trial;
}

Trial to_and_fro(std::uint64_t seed) {
  Draft draft(seed);
  const double speed = draft.between(0.05, 1);
  draft.floor().motion.swing = draft.between(0.02, 0.1) * kUp;
  draft.floor().motion.frequency =
      speed / (2 * std::numbers::pi * draft.floor().motion.swing.norm());
  draft.hand();
  return draft.trial;
}

Trial jumps(std::uint64_t seed) {
  Draft draft(seed);
  draft.moves(draft.floor(), draft.between(0.005, 0.1) / 1e-6 * kUp, kHappens, 1e-6);
  draft.hand();
  return draft.trial;
}

Trial plate_appears(std::uint64_t seed) {
  Draft draft(seed);
  draft.hand();
  const double thick = draft.between(0.005, 0.05);
  const Vector3d at = draft.trial.hip[2500];
  SimulatedSolid& plate = draft.add(
      SolidKind::block, {at.x(), at.y(), std::max(at.z(), 0.) + draft.between(-0.01, 0.04)},
      {0.1, 0.1, thick / 2});
  draft.comes(plate, kHappens);
  return draft.trial;
}

// Something is laid between the camera and the tool; for one frame, nothing is measured.
Trial laid_over(std::uint64_t seed) {
  Draft draft(seed);
  draft.hand();
  const Vector3d at = draft.trial.hip[2500];
  const double above = std::max(at.z(), 0.) + draft.between(0.01, 0.06);
  SimulatedSolid& thing =
      draft.add(SolidKind::block, {at.x(), at.y(), above + 0.015}, {0.08, 0.08, 0.015});
  draft.comes(thing, kHappens);
  const double shadow = draft.one_of({0, 1}) / draft.trial.cameras.front().options.rate;
  draft.trial.cameras.front().fault = [=](DepthFrame& frame) {
    if (frame.stamp > kHappens && frame.stamp < kHappens + shadow)
      std::ranges::fill(frame.depth, 0.0f);
    return true;
  };
  return draft.trial;
}

Trial ball_comes(std::uint64_t seed) {
  Draft draft(seed);
  draft.hand();
  const Vector3d at = draft.trial.hip[2500];
  const Vector3d way = (draft.level() + draft.between(-0.5, 1) * kUp).normalized();
  const double speed = draft.between(0.05, 1);
  const Vector3d goal(at.x(), at.y(), std::max(at.z(), 0.));
  SimulatedSolid& ball = draft.add(SolidKind::ball, goal - 0.3 * way, {0.06, 0.06, 0.06});
  draft.moves(ball, speed * way, kHappens, std::min(draft.between(0.2, 0.5) / speed, 4.));
  return draft.trial;
}

Trial box_slides(std::uint64_t seed) {
  Draft draft(seed);
  draft.hand();
  const Vector3d at = draft.trial.hip[2500];
  const Vector3d way = draft.level();
  const double speed = draft.between(0.05, 1);
  SimulatedSolid& box =
      draft.add(SolidKind::block, Vector3d(at.x(), at.y(), 0.04) - 0.35 * way, {0.05, 0.05, 0.04});
  draft.moves(box, speed * way, kHappens, draft.between(0.25, 0.6) / speed);
  return draft.trial;
}

// Something passes between the camera and the hand.
Trial passes_before(std::uint64_t seed) {
  Draft draft(seed);
  draft.hand();
  const Vector3d eye = draft.trial.cameras.front().options.T_world_camera.translation();
  const Vector3d way = draft.level();
  const double speed = draft.between(0.1, 0.5);
  SimulatedSolid& arm = draft.add(SolidKind::block, 0.5 * eye - 0.5 * way, {0.06, 0.06, 0.03});
  draft.moves(arm, speed * way, kHappens, 1 / speed);
  return draft.trial;
}

Trial hole(std::uint64_t seed) {
  Draft draft(seed);
  const double speed = draft.one_of({0, 0.05, 0.25});
  draft.moves(draft.floor(), speed * kUp, kHappens + 0.2, speed > 0 ? 0.1 / speed : 0.);
  draft.hand();
  draft.hole(draft.trial.cameras.front(), kHappens, draft.between(0.3, 3));
  return draft.trial;
}

Trial one_of_two_is_silent(std::uint64_t seed) {
  Draft draft(seed);
  draft.camera().fault = [](DepthFrame& frame) { return frame.stamp < kHappens; };
  draft.floor_rises(draft.between(0.02, 0.3), 0.1, kHappens + 0.5);
  draft.hand();
  return draft.trial;
}

Trial two_cameras(std::uint64_t seed) {
  Draft draft(seed);
  draft.camera();
  draft.floor_rises(draft.between(0.05, 0.5), 0.15);
  draft.hand();
  return draft.trial;
}

Trial begins_behind(std::uint64_t seed) {
  Draft draft(seed);
  draft.hand();
  const double depth = draft.between(0.01, 0.05);
  for (std::size_t i = 0; i < 2500; ++i) draft.trial.hip[i] = {0, 0, -depth};
  return draft.trial;
}

Trial frames_are_lost(std::uint64_t seed) {
  Draft draft(seed);
  draft.trial.cameras.front().options.dropped = 0.4;
  draft.floor_rises(draft.between(0.05, 0.5), 0.15);
  draft.hand();
  return draft.trial;
}

Trial with_size(std::uint64_t seed) {
  Trial trial = seed % 2 == 0 ? comes_on(seed) : ball_comes(seed);
  trial.tool_radius = 0.004;
  return trial;
}

// Everything stands still, and the hand presses, slides and is lifted in front of it.
Trial rests(std::uint64_t seed) {
  Draft draft(seed);
  draft.trial.cameras.front().options.dropped = 0;
  const Vector3d aside = 0.12 * draft.level();
  draft.add(SolidKind::ball, aside, {0.05, 0.05, 0.05});
  draft.add(SolidKind::block, -aside, {0.04, 0.04, 0.03});
  draft.hand();
  return draft.trial;
}

Trial rests_under_two(std::uint64_t seed) {
  Trial trial = rests(seed);
  Trial other = rests(seed + 1000003);
  trial.cameras.push_back(other.cameras.front());
  return trial;
}

Trial rests_with_size(std::uint64_t seed) {
  Trial trial = rests(seed);
  trial.tool_radius = 0.004;
  return trial;
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
          {"at rest, tool with size", rests_with_size}};
}

}  // namespace palpate::robot
