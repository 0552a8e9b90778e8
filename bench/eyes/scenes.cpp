// Draws the scenes and their cameras.
#include <cmath>
#include <numbers>

#include "eyes/view.hpp"

namespace palpate::eyes {
namespace {

/// What stands on the floor reaches into it: an ideal proxy would go into a seam.
void root(SimulatedSolid& solid) {
  constexpr double kRoot = 0.02;  // m
  Eigen::Isometry3d& pose = solid.solid.T_world_solid;
  const bool upright = std::abs(pose.linear()(2, 2)) > 0.999;
  if (!upright || std::abs(pose.translation().z() - solid.solid.size.z()) > 1e-6) return;
  pose.translation().z() -= kRoot / 2;
  solid.solid.size.z() += kRoot / 2;
}

void floor(View& view) {
  view.scene.solids.emplace_back();
}

void stairs(View& view) {
  floor(view);
  const double turn = view.between(-0.6, 0.6);
  const double rise = view.between(0.008, 0.04);
  const double tread = view.between(0.02, 0.06);
  const Vector3d along(std::cos(turn), std::sin(turn), 0);
  for (int k = 0; k < 4; ++k) {
    const double height = rise * (k + 1);
    view.block((0.02 + tread * k + 0.1) * along + 0.5 * height * kUp, {0.1, 0.1, height / 2}, turn);
  }
}

void grooves(View& view) {
  floor(view);
  const double turn = view.between(0, std::numbers::pi);
  const double height = view.between(0.008, 0.03);
  const double width = view.between(0.02, 0.05);
  const double gap = view.between(0.004, 0.02);
  const Vector3d along(std::cos(turn), std::sin(turn), 0);
  for (int k = -2; k <= 2; ++k) {
    view.block(k * (width + gap) * along + 0.5 * height * kUp, {width / 2, 0.1, height / 2}, turn);
  }
}

void letters(View& view) {
  floor(view);
  const double height = view.between(0.004, 0.012);
  for (int k = 0; k < 7; ++k) {
    const Vector3d at(view.between(-0.09, 0.09), view.between(-0.1, 0.1), height / 2);
    view.block(at, {view.between(0.015, 0.03), view.between(0.003, 0.008), height / 2},
               view.between(0, std::numbers::pi));
  }
}

void plates(View& view) {
  floor(view);
  for (int k = 0; k < 2; ++k) {
    const double height = view.between(0.03, 0.08);
    view.block({view.between(-0.05, 0.08), 0.09 * (2 * k - 1), height / 2 + 0.02},
               {view.between(0.002, 0.005), view.between(0.03, 0.06), height / 2},
               view.between(-0.8, 0.8), view.between(-0.4, 0.4));
  }
}

void fins(View& view) {
  floor(view);
  const double turn = view.between(-0.5, 0.5);
  const double pitch = view.between(0.02, 0.045);
  const double height = view.between(0.02, 0.06);
  const Vector3d across(-std::sin(turn), std::cos(turn), 0);
  for (int k = -2; k <= 2; ++k) {
    view.block(k * pitch * across + 0.5 * height * kUp,
               {0.05, view.between(0.002, 0.005), height / 2}, turn);
  }
}

void corner(View& view) {
  floor(view);
  const double height = view.between(0.05, 0.12);
  view.block({view.between(-0.02, 0.05), view.between(-0.05, 0.05), height / 2},
             {view.between(0.03, 0.07), view.between(0.03, 0.07), height / 2},
             view.between(0, std::numbers::pi), view.one_of({0, 0, view.between(-0.3, 0.3)}));
}

void cup(View& view) {
  floor(view);
  constexpr int kStaves = 16;
  const double radius = view.between(0.03, 0.05);
  const double height = view.between(0.04, 0.1);
  for (int k = 0; k < kStaves; ++k) {
    const double turn = 2 * std::numbers::pi * k / kStaves;
    view.block(radius * Vector3d(std::cos(turn), std::sin(turn), 0) + 0.5 * height * kUp,
               {0.002, 1.02 * radius * std::tan(std::numbers::pi / kStaves), height / 2}, turn);
  }
}

void gaps(View& view) {
  floor(view);
  const double turn = view.between(-1.2, 1.2);
  const double gap = view.between(0.005, 0.025);
  const double height = view.between(0.03, 0.08);
  const Vector3d across(-std::sin(turn), std::cos(turn), 0);
  for (const double side : {-1.0, 1.0}) {
    view.block(side * (0.04 + gap / 2) * across + 0.5 * height * kUp, {0.06, 0.04, height / 2},
               turn);
  }
}

void rods(View& view) {
  floor(view);
  for (int k = 0; k < 3; ++k) {
    const double radius = view.between(0.004, 0.01);
    const Vector3d axis = k == 0 ? kUp : view.level_direction();
    const double up = k == 0 ? 0.06 : view.between(radius, 0.06);
    view.rod({view.between(-0.05, 0.05), 0.07 * (k - 1), up}, axis, radius, 0.12);
  }
}

void hand(View& view) {
  floor(view);
  const double up = view.between(0.06, 0.12);
  const double turn = view.between(-1, 1);
  const Vector3d along(std::cos(turn), std::sin(turn), 0);
  const Vector3d across(-std::sin(turn), std::cos(turn), 0);
  view.block(up * kUp, {0.045, 0.04, 0.012}, turn);
  for (int k = 0; k < 4; ++k) {
    const Vector3d root = 0.045 * along + 0.022 * (k - 1.5) * across + up * kUp;
    view.rod(root + 0.03 * along, along, 0.009, 0.06);
    view.ball(root + 0.06 * along, 0.009);
  }
  view.rod(0.05 * across + up * kUp, (across + 0.6 * along).normalized(), 0.011, 0.05);
}

void table(View& view) {
  floor(view);
  const double thick = view.between(0.008, 0.03);
  view.block({view.between(-0.02, 0.05), view.between(-0.03, 0.03), 0.2},
             {view.between(0.06, 0.1), view.between(0.06, 0.1), thick / 2},
             view.between(0, std::numbers::pi));
}

void things(View& view) {
  floor(view);
  view.ball({0.02, -0.08, view.between(0.02, 0.09)}, view.between(0.02, 0.05));
  const double radius = view.between(0.02, 0.04);
  view.rod({0.02, 0.08, view.between(0.03, 0.06)},
           view.one_of({0, 1}) > 0 ? kUp : Vector3d::UnitX(), radius, view.between(0.06, 0.12));
  view.block({-0.04, 0, 0.02}, Vector3d::Constant(0.02), view.between(0, 1.5));
}

void slopes(View& view) {
  floor(view);
  const double lean = view.between(0.2, 1.3);
  view.block({0.03, 0, 0.05}, {0.05, 0.1, 0.01}, view.between(-0.7, 0.7), -lean);
}

void blinds(View& view) {
  floor(view);
  const Eigen::Isometry3d board = view.board();
  const double width = view.one_of({view.between(0.003, 0.008), view.between(0.008, 0.03)});
  const double lean = view.one_of({0, view.between(-70, 70)}) * kDegree;
  const double pitch = view.draw_gap() + width * std::cos(lean);
  for (int k = -3; k <= 3; ++k) {
    view.bar(board, {k * pitch, 0, 0}, {width / 2, 0.12, view.between(0.001, 0.003)}, lean);
    view.gaps.emplace_back(board * Vector3d((k + 0.5) * pitch, view.between(-0.08, 0.08), 0));
  }
  view.gaps.pop_back();
}

void sieve(View& view) {
  floor(view);
  const Eigen::Isometry3d board = view.board();
  const double width = view.between(0.006, 0.015);
  const double pitch = view.draw_gap() + width;
  const double thick = view.between(0.001, 0.003);
  for (int k = -3; k <= 3; ++k) {
    view.bar(board, {k * pitch, 0, 0}, {width / 2, 3 * pitch, thick});
    view.bar(board, {0, k * pitch, 0}, {3 * pitch, width / 2, thick});
  }
  for (int k = -3; k < 3; ++k) {
    for (int l = -3; l < 3; ++l)
      view.gaps.emplace_back(board * Vector3d((k + 0.5) * pitch, (l + 0.5) * pitch, 0));
  }
}

void tines(View& view) {
  floor(view);
  const Eigen::Isometry3d board = view.board();
  const double radius = view.between(0.003, 0.008);
  const double pitch = view.draw_gap() + 2 * radius;
  for (int k = -2; k <= 2; ++k) {
    view.add(SolidKind::cylinder, board * Vector3d(k * pitch, 0, 0), {radius, radius, 0.1},
             board.linear().col(1));
    view.gaps.emplace_back(board * Vector3d((k + 0.5) * pitch, view.between(-0.06, 0.06), 0));
  }
  view.gaps.pop_back();
}

SimulatedCameraOptions draw_camera(View& view) {
  const double height = view.between(20, 65) * kDegree;
  const double turn = view.between(-25, 25) * kDegree;
  const double far = view.between(0.5, 1.2);
  const Vector3d from(-std::cos(height) * std::cos(turn), -std::cos(height) * std::sin(turn),
                      std::sin(height));
  SimulatedCameraOptions camera;
  camera.T_world_camera = bench::looking(far * from, 0.05 * kUp, kUp);
  camera.noise.silhouettes = true;
  camera.noise.seed = view.random.bits();
  return camera;
}

}  // namespace

View::View(std::uint64_t number) : Stage(number) {
  cameras.push_back(draw_camera(*this));
}

void View::oppose() {
  SimulatedCameraOptions camera = draw_camera(*this);
  camera.T_world_camera = Eigen::AngleAxisd(std::numbers::pi, kUp) * camera.T_world_camera;
  cameras.push_back(camera);
}

void View::block(const Vector3d& center, const Vector3d& half, double turn, double tilt) {
  SimulatedSolid& solid = add(SolidKind::block, center, half);
  solid.solid.T_world_solid.linear() =
      (Eigen::AngleAxisd(turn, kUp) * Eigen::AngleAxisd(tilt, Vector3d::UnitY()))
          .toRotationMatrix();
  root(solid);
}

void View::rod(const Vector3d& center, const Vector3d& axis, double radius, double length) {
  root(add(SolidKind::cylinder, center, {radius, radius, length / 2}, axis));
}

Eigen::Isometry3d View::board() {
  const Vector3d middle(0, 0, 0.15);
  Eigen::Isometry3d board = Eigen::Isometry3d::Identity();
  board.translation() = middle;
  const Vector3d out = cameras.front().T_world_camera.translation() - middle;
  board.linear() = (Eigen::AngleAxisd(between(0, 25) * kDegree, level_direction()) *
                    Eigen::Quaterniond::FromTwoVectors(kUp, out) *
                    Eigen::AngleAxisd(between(0, std::numbers::pi), kUp))
                       .toRotationMatrix();
  if (one_of({0, 1}) > 0) {
    constexpr double kThick = 0.01;
    behind = between(0.012, 0.06);
    bar(board, {0, 0, -behind - kThick}, {0.3, 0.3, kThick});
  }
  return board;
}

void View::bar(const Eigen::Isometry3d& board, const Vector3d& center, const Vector3d& half,
               double lean) {
  add(SolidKind::block, board * center, half).solid.T_world_solid.linear() =
      board.linear() * Eigen::AngleAxisd(lean, Vector3d::UnitY()).toRotationMatrix();
}

double View::draw_gap() {
  const SimulatedCameraOptions& camera = cameras.front();
  const double pixel = camera.T_world_camera.translation().norm() / camera.camera.pinhole.fx;
  return gap = between(10, 20) * pixel;
}

void View::ball(const Vector3d& center, double radius) {
  add(SolidKind::ball, center, Vector3d::Constant(radius));
}

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> kAll = {
      {"stairs", stairs}, {"grooves", grooves}, {"letters", letters}, {"plates", plates},
      {"fins", fins},     {"corner", corner},   {"cup", cup},         {"gaps", gaps},
      {"rods", rods},     {"hand", hand},       {"table", table},     {"things", things},
      {"slopes", slopes}, {"blinds", blinds},   {"sieve", sieve},     {"tines", tines}};
  return kAll;
}

}  // namespace palpate::eyes
