// Rows of what a letter hides of the table that it stands on, and of rims behind which nothing is.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "events/event.hpp"

namespace palpate::events {
namespace {

using Eigen::Vector3d;

constexpr double kDegrees = std::numbers::pi / 180;

/// A bar on the table, as the stroke of a letter, and the strip that it hides.
struct Letter {
  Eigen::Matrix3d axes;  // the bar's: across, along and up; across points away from the camera
  Vector3d foot;         // middle of where the bar's back meets the table
  double half_length;    // m
  double strip;          // m across

  [[nodiscard]] Vector3d at(double across, double along, double up) const {
    return foot + axes * Vector3d(across, along, up);
  }
};

Letter put_letter(Event& event, double low, double high) {
  const double tilt = 90 * kDegrees - event.between(25, 60) * kDegrees;
  event.look_from(tilt, event.between(0.5, 1));
  event.clear();
  const double height = event.between(low, high);
  const Vector3d half(event.between(3e-3, 7.5e-3), event.between(15e-3, 30e-3), height / 2);
  const double turn = event.between(-30, 30) * kDegrees;
  Letter letter;
  letter.axes = Eigen::AngleAxisd(turn, kUp).toRotationMatrix();
  const Vector3d middle(event.between(-0.03, 0.03), event.between(-0.03, 0.03), height / 2);
  event.block(middle, kUp, half).solid.T_world_solid.linear() = letter.axes;
  letter.foot = middle + letter.axes * Vector3d(half.x(), 0, -half.z());
  letter.half_length = half.y();
  letter.strip = height * std::tan(tilt) * std::cos(turn);
  return letter;
}

/// Watches for so many frames; 0: for as long as the hand goes.
void watch(Event& event, const std::string& family, int frames) {
  if (!family.empty()) event.seen_by(family);
  event.camera.frames = frames;
}

// Past the bar's end, away from the camera, then along the strip and out of it behind.
void behind_letter(Event& event, const std::string& family, int frames) {
  watch(event, family, frames);
  const Letter letter = put_letter(event, 4e-3, 12e-3);
  const double beside = letter.half_length + 0.015;
  const double middle = letter.strip / 2;
  event.press(letter.at(-0.01, beside, 0), kUp);
  event.go(letter.at(middle, beside, -kPress), 0.04);
  event.go(letter.at(middle, letter.half_length, -kPress), 0.04);
  event.happens();
  event.go(letter.at(middle, 0, -kPress), 0.04);
  event.go(letter.at(letter.strip + 0.01, -0.3 * letter.half_length, -kPress), 0.04);
}

// The same 5 mm above the table: nothing may hold the hand.
void above_strip(Event& event, const std::string& family, int frames) {
  constexpr double kAbove = 5e-3;
  watch(event, family, frames);
  const Letter letter = put_letter(event, 8e-3, 12e-3);
  const double middle = std::max(letter.strip / 2, 4e-3);
  event.start(letter.at(middle, letter.half_length + 0.03, kAbove));
  event.hold(1.5);
  event.happens();
  event.go(letter.at(middle, -letter.half_length, kAbove), 0.04);
  event.go(letter.at(letter.strip + 0.02, 0, kAbove), 0.04);
}

// Along the letter's top: what goes on below it may not draw it down.
void on_letter(Event& event, const std::string& family, int frames) {
  watch(event, family, frames);
  const Letter letter = put_letter(event, 8e-3, 12e-3);
  const Eigen::Isometry3d top = event.scene.solids.back().solid.T_world_solid;
  const double height = 2 * top.translation().z();
  const Vector3d middle = top.translation() + height / 2 * kUp;
  const Vector3d along = 0.6 * letter.half_length * letter.axes.col(1);
  event.press(middle - along, kUp);
  event.go(middle + along - kPress * kUp, 0.03);
}

// Off a table's edge with the floor below, at the table's height.
void off_table(Event& event, const std::string& family, int frames) {
  watch(event, family, frames);
  event.look_from(event.between(30, 65) * kDegrees, event.between(0.5, 0.8));
  event.clear();
  event.scene.solids[0].solid.T_world_solid.translation() = -0.3 * kUp;
  const double end = event.between(0.03, 0.06);
  event.block(Vector3d(end - 0.2, 0, -0.01), kUp, Vector3d(0.2, 0.2, 0.01));
  const double aside = event.between(-0.05, 0.05);
  event.start(Vector3d(end + 0.015, aside, 0.02));
  event.hold(1.5);
  event.happens();
  event.go(Vector3d(end + 0.015, aside, -0.01), 0.04);
  event.go(Vector3d(end + 0.06, aside, -0.05), 0.04);
}

}  // namespace

std::vector<Row> hidden_rows() {
  using Draw = void (*)(Event&, const std::string&, int);
  const std::pair<const char*, Draw> kinds[] = {{"behind a letter", behind_letter},
                                                {"above what a letter hides", above_strip},
                                                {"on a letter", on_letter},
                                                {"off a table", off_table}};
  std::vector<Row> rows;
  for (const auto& [name, draw] : kinds) {
    for (const std::string family : {"", "structured", "stereo", "tof"}) {
      for (const int frames : {0, 20, 1}) {
        const std::string seen = frames == 0 ? "" : fmt::format(", {} frames", frames);
        const std::string by = family.empty() ? "" : ", " + family;
        rows.push_back({name + by + seen, [=, draw = draw](Event& e) { draw(e, family, frames); }});
      }
    }
  }
  return rows;
}

}  // namespace palpate::events
