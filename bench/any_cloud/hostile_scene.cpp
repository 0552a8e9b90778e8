// Makes a scene of a row and a seed, and brings it into a pose and a unit.
#include "any_cloud/hostile_scene.hpp"

#include <array>

namespace palpate::any_cloud {
namespace {

using Eigen::Vector3d;

constexpr double kMetre = 1e-3;                          // a spacing
constexpr double kAway = 200;                            // spacings, at most along an axis
constexpr double kUpright = 0.3;                         // share of the scenes
constexpr std::array kUnits{1.0, 1.0, 1e3, 1 / 0.3048};  // of a metre; the second has an origin

std::uint64_t hash(const std::string& text) {
  std::uint64_t value = 14695981039346656037u;  // FNV-1a
  for (const char letter : text) {
    value = (value ^ static_cast<unsigned char>(letter)) * 1099511628211u;
  }
  return value;
}

// PrepareOptions::Orientation may look at what is up, so some scenes stay upright.
Eigen::Quaterniond turn(Random& random) {
  if (random.uniform() < kUpright) return Eigen::Quaterniond::Identity();
  const double w = random.normal();
  const double x = random.normal();
  const double y = random.normal();
  return Eigen::Quaterniond(w, x, y, random.normal()).normalized();
}

}  // namespace

HostileScene make_scene(const Row& row, std::uint64_t seed) {
  Draft draft(hash(row.name) ^ (seed * 0x9e3779b97f4a7c15u));
  row.draw(draft);
  const std::size_t unit = draft.random.bits() % kUnits.size();
  HostileScene scene;
  scene.spacing = kMetre * kUnits[unit];
  if (unit == 1) scene.cloud.origin = {5e5, 5.4e6, 100};
  const Eigen::Matrix3d R = turn(draft.random).toRotationMatrix();
  const Vector3d moved = draft.within(Vector3d::Constant(-kAway), Vector3d::Constant(kAway));
  const auto placed = [&](const Vector3d& x) { return Vector3d(scene.spacing * (R * x + moved)); };
  for (std::size_t i = 0; i < draft.points.size(); ++i) {
    Vector3d point = draft.points[i];
    if (draft.noise > 0) point += draft.noise * draft.random.normal() * draft.normals[i];
    scene.cloud.positions.push_back(placed(point).cast<float>());
    if (draft.give_normals) scene.cloud.normals.push_back((R * draft.normals[i]).cast<float>());
  }
  if (draft.viewpoint) scene.cloud.viewpoint = scene.cloud.origin + placed(*draft.viewpoint);
  scene.ticks = std::move(draft.hand.ticks);
  for (HandTick& tick : scene.ticks) tick.hand = scene.cloud.origin + placed(tick.hand);
  scene.truth = std::move(draft.truth);
  scene.stiffness = kNewtonsPerSpacing / scene.spacing;
  scene.deep = draft.deep;
  scene.clear = draft.clear;
  scene.T_world_draft.linear() = R;
  scene.T_world_draft.translation() = scene.cloud.origin + scene.spacing * moved;
  return scene;
}

Distance true_surface(const HostileScene& scene, const Vector3d& x) {
  return scene.truth(scene.T_world_draft.inverse() * x / scene.spacing);
}

double true_distance(const HostileScene& scene, const Vector3d& x) {
  return true_surface(scene, x).value;
}

}  // namespace palpate::any_cloud
