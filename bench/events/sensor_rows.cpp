#include <numbers>

#include "events/draft.hpp"
#include "events/rows.hpp"
#include "sim/simulated_camera.hpp"

// What is thin, slanted or has a rim, as families of sensors see it.

namespace palpate::events {
namespace {

using Eigen::Vector3d;

// As a family of sensors sees it: structured, stereo, tof.
void seen_by(Draft& draft, const std::string& family) {
  SimulatedSetup setup;
  setup.camera.noise.seed = draft.event.camera.noise.seed;
  set_simulated(setup, "noise=" + family);
  draft.event.camera.noise = setup.camera.noise;
}

// Presses all over a table that is seen at a slant; each has to hold.
Event slant(std::uint64_t seed, const std::string& family) {
  Draft draft(seed);
  const double tilt = draft.between(60, 70) * std::numbers::pi / 180;
  const double far = draft.between(0.7, 1.1);
  draft.look_from(far * Vector3d(-std::sin(tilt), 0, std::cos(tilt)));
  draft.event.scene.solids.resize(1);
  seen_by(draft, family);
  draft.start(draft.place + 0.02 * kUp);
  draft.hold(0.6);
  for (int i = 0; i < 8; ++i) {
    const Vector3d next(draft.between(-0.15, 0.15), draft.between(-0.15, 0.15), 0);
    draft.go(next + 0.02 * kUp, 0.3);
    draft.go(next - kPress * kUp, 0.05);
    draft.hold(0.2);
    draft.go(next + 0.02 * kUp, 0.1);
  }
  draft.event.begin = 600;
  draft.event.depth = kPress;
  draft.event.when_deep = true;
  return draft.event;
}

// A hand rests on a thin pole, as a family sees it; no family: the noise has the same deviation
// everywhere.
Event pole(std::uint64_t seed, const std::string& family) {
  Draft draft(seed);
  const double radius = draft.one_of({0.004, 0.0075, 0.0125, 0.02});
  if (family.empty()) {
    const double sigma = draft.one_of({0.001, 0.003, 0.006, 0.015});
    draft.event.camera.noise.model.coefficients = {sigma, 0, 0};
  } else {
    seen_by(draft, family);
  }
  const Vector3d middle = draft.place + draft.between(0.08, 0.15) * kUp;
  draft.cylinder(middle, kUp, radius, 0.3);
  Vector3d out = draft.to_camera(middle);
  out.z() = 0;
  out.normalize();
  draft.press(middle + radius * out, out);
  draft.hold(3);
  return draft.event;
}

// Over the rim of a plate, 3 mm deep and beyond.
Event over_rim(std::uint64_t seed, const std::string& family) {
  Draft draft(seed);
  if (!family.empty()) seen_by(draft, family);
  const Vector3d middle = draft.place + draft.between(0.1, 0.16) * kUp;
  const Vector3d out = draft.to_camera(middle);
  draft.block(middle - 0.02 * out, out, Vector3d(0.04, 0.04, 0.02));
  const Vector3d along =
      draft.event.scene.solids.back().solid.T_world_solid.linear() * draft.level_direction();
  draft.press(middle, out);
  draft.event.depth = 0;
  draft.go(middle - kPress * out + 0.08 * along, 0.05);
  return draft.event;
}

// Along the rim of a plate, 2 mm inside of it and 3 mm deep: what shakes the force is a washboard.
Event along_rim(std::uint64_t seed, const std::string& family) {
  Draft draft(seed);
  if (!family.empty()) seen_by(draft, family);
  const Vector3d middle = draft.place + draft.between(0.1, 0.16) * kUp;
  const Vector3d out = draft.to_camera(middle);
  const SimulatedSolid& plate = draft.block(middle - 0.02 * out, out, Vector3d(0.04, 0.04, 0.02));
  const Eigen::Matrix3d axes = plate.solid.T_world_solid.linear();
  const int across = draft.between(0, 1) < 0.5 ? 0 : 1;
  const Vector3d rim = middle + (draft.between(0, 1) < 0.5 ? 1 : -1) * 0.038 * axes.col(across);
  const Vector3d along = axes.col(1 - across);
  draft.press(rim - 0.03 * along, out);
  draft.go(rim + 0.03 * along - kPress * out, 0.03);
  return draft.event;
}

}  // namespace

std::vector<Row> sensor_rows() {
  std::vector<Row> rows;
  const auto add = [&](const std::string& name, const std::string& family, const auto& make) {
    rows.push_back({family.empty() ? name : name + ", " + family,
                    [=](std::uint64_t seed) { return make(seed, family); }});
  };
  for (const std::string family : {"", "structured", "stereo", "tof"}) {
    add("pole", family, pole);
    if (!family.empty()) add("slant", family, slant);
    add("over a rim", family, over_rim);
    add("along a rim", family, along_rim);
  }
  return rows;
}

}  // namespace palpate::events
