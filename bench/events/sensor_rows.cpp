// Rows of thin, slanted and rimmed things, as families of sensors see them.
#include <numbers>

#include "events/event.hpp"

namespace palpate::events {
namespace {

using Eigen::Vector3d;

// Presses all over a table that is seen at a slant; each has to hold.
void slant(Event& event, const std::string& family) {
  const double tilt = event.between(60, 70) * std::numbers::pi / 180;
  const double far = event.between(0.7, 1.1);
  event.look_from(tilt, far);
  event.clear();
  event.seen_by(family);
  event.start(event.place + 0.02 * kUp);
  event.hold(0.6);
  for (int i = 0; i < 8; ++i) {
    const Vector3d next(event.between(-0.15, 0.15), event.between(-0.15, 0.15), 0);
    event.go(next + 0.02 * kUp, 0.3);
    event.go(next - kPress * kUp, 0.05);
    event.hold(0.2);
    event.go(next + 0.02 * kUp, 0.1);
  }
  event.begin = 600;
  event.depth = kPress;
  event.when_deep = true;
}

// A hand rests on a thin pole, as a family sees it; no family: the noise has the same deviation
// everywhere.
void pole(Event& event, const std::string& family) {
  const double radius = event.one_of({0.004, 0.0075, 0.0125, 0.02});
  if (family.empty()) {
    const double sigma = event.one_of({0.001, 0.003, 0.006, 0.015});
    event.camera.noise.model.coefficients = {sigma, 0, 0};
  } else {
    event.seen_by(family);
  }
  const Vector3d middle = event.place + event.between(0.08, 0.15) * kUp;
  event.cylinder(middle, kUp, radius, 0.3);
  Vector3d out = event.to_camera(middle);
  out.z() = 0;
  out.normalize();
  event.press(middle + radius * out, out);
  event.hold(3);
}

// Over the rim of a plate, 3 mm deep and beyond.
void over_rim(Event& event, const std::string& family) {
  if (!family.empty()) event.seen_by(family);
  const Vector3d middle = event.place + event.between(0.1, 0.16) * kUp;
  const Vector3d out = event.to_camera(middle);
  event.block(middle - 0.02 * out, out, Vector3d(0.04, 0.04, 0.02));
  const Vector3d along =
      event.scene.solids.back().solid.T_world_solid.linear() * event.level_direction();
  event.press(middle, out);
  event.depth = 0;
  event.go(middle - kPress * out + 0.08 * along, 0.05);
}

// Along the rim of a plate, 2 mm inside of it and 3 mm deep: what shakes the force is a washboard.
void along_rim(Event& event, const std::string& family) {
  if (!family.empty()) event.seen_by(family);
  const Vector3d middle = event.place + event.between(0.1, 0.16) * kUp;
  const Vector3d out = event.to_camera(middle);
  const SimulatedSolid& plate = event.block(middle - 0.02 * out, out, Vector3d(0.04, 0.04, 0.02));
  const Eigen::Matrix3d axes = plate.solid.T_world_solid.linear();
  const int across = event.between(0, 1) < 0.5 ? 0 : 1;
  const Vector3d rim = middle + (event.between(0, 1) < 0.5 ? 1 : -1) * 0.038 * axes.col(across);
  const Vector3d along = axes.col(1 - across);
  event.press(rim - 0.03 * along, out);
  event.go(rim + 0.03 * along - kPress * out, 0.03);
}

}  // namespace

std::vector<Row> sensor_rows() {
  std::vector<Row> rows;
  const auto add = [&](const std::string& name, const std::string& family, const auto& make) {
    rows.push_back(
        {family.empty() ? name : name + ", " + family, [=](Event& e) { make(e, family); }});
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
