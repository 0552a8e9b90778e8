// The scenes and cameras behind the names of simulated cameras.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "base/numbers.hpp"
#include "palpate/base/error.hpp"
#include "sim/simulated_camera.hpp"
#include "sim/simulated_scene.hpp"

namespace palpate {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// All scenes are where they were after so long: cameras that are opened one after the other see
// one world, s.
constexpr double kPeriod = 20;

SimulatedSetup still() {
  const SimulatedTable table = make_simulated_table();
  SimulatedSetup setup{table.scene, {}};
  setup.camera.T_world_camera = table.T_world_camera;
  setup.camera.noise.silhouettes = true;
  return setup;
}

// The sphere goes to and fro at up to 19 mm/s.
SimulatedSetup table() {
  SimulatedSetup setup = still();
  SimulatedMotion& motion = setup.scene.solids[kSphere].motion;
  motion.swing = Vector3d(0, 0.03, 0);
  motion.frequency = 0.1;
  return setup;
}

// The table with a wire across it, 8 mm thick.
SimulatedSetup desk() {
  SimulatedSetup setup = table();
  Isometry3d wire = Isometry3d::Identity();
  wire.linear() = Eigen::AngleAxisd(90 * kDegree, Vector3d::UnitX()).toRotationMatrix();
  wire.translation() = Vector3d(-0.12, 0, 0.06);
  setup.scene.solids.push_back({{SolidKind::cylinder, wire, Vector3d(4e-3, 4e-3, 0.12)}, {}});
  return setup;
}

// The same table from the other side of its sphere and box.
SimulatedSetup turned(double angle) {
  SimulatedSetup setup = still();
  const Isometry3d turn(Eigen::AngleAxisd(angle, Vector3d::UnitZ()));
  setup.camera.T_world_camera = turn * setup.camera.T_world_camera;
  return setup;
}

// 5 cm/s to the side and 10 degrees a second at most.
SimulatedSetup wandering() {
  SimulatedSetup setup = still();
  SimulatedMotion& motion = setup.camera.motion;
  motion.frequency = 0.25;
  const double rate = 2 * std::numbers::pi * motion.frequency;
  motion.swing = Vector3d(0, 0.05 / rate, 0);
  motion.rock = 10 * kDegree / rate;
  return setup;
}

// An arm, 80 mm thick, whose lower side is 130 mm above the table goes to and fro over it, at up to
// 0.3 m/s.
SimulatedSetup arm() {
  SimulatedSetup setup = still();
  Isometry3d along = Isometry3d::Identity();
  along.linear() = Eigen::AngleAxisd(90 * kDegree, Vector3d::UnitY()).toRotationMatrix();
  along.translation() = Vector3d(0, 0, 0.17);
  SimulatedMotion motion;
  motion.frequency = 0.3;
  motion.swing = Vector3d(0, 0.3 / (2 * std::numbers::pi * motion.frequency), 0);
  setup.scene.solids.push_back({{SolidKind::cylinder, along, Vector3d(0.04, 0.04, 0.3)}, motion});
  return setup;
}

// The table and the wall alone.
SimulatedSetup slant() {
  SimulatedSetup setup = still();
  setup.scene.solids.resize(2);
  set_simulated(setup, "tilt=65");
  return setup;
}

// Upright, 1 m away and half a metre before the wall.
SimulatedSetup poles() {
  SimulatedSetup setup = still();
  setup.scene.solids = {setup.scene.solids[kWall]};
  set_simulated(setup, "tilt=90");
  setup.camera.T_world_camera.translation().normalize();
  Isometry3d pose = Isometry3d::Identity();
  pose.translation().y() = 0.3;
  for (const double thickness : {8e-3, 15e-3, 25e-3, 40e-3}) {
    const Vector3d size(thickness / 2, thickness / 2, 1);
    setup.scene.solids.push_back({{SolidKind::cylinder, pose, size}, {}});
    pose.translation().y() -= 0.2;
  }
  return setup;
}

// A wall and a ball before it come and go along the optical axis, at up to 5 cm/s.
SimulatedSetup approach() {
  SimulatedSetup setup;
  Isometry3d wall = Isometry3d::Identity();
  wall.linear() = Eigen::AngleAxisd(std::numbers::pi, Vector3d::UnitX()).toRotationMatrix();
  wall.translation() = Vector3d(0, 0, 0.9);
  Isometry3d middle = Isometry3d::Identity();
  middle.translation() = Vector3d(0.15, 0, 0.8);
  SimulatedMotion motion;
  motion.frequency = 0.1;
  motion.swing = Vector3d(0, 0, -0.05 / (2 * std::numbers::pi * motion.frequency));
  setup.scene.solids = {{{SolidKind::half_space, wall, Vector3d::Zero()}, motion},
                        {{SolidKind::ball, middle, Vector3d::Constant(0.06)}, motion}};
  setup.camera.noise.silhouettes = true;
  return setup;
}

struct Named {
  const char* name;
  const char* description;
  SimulatedSetup (*make)();
};

constexpr std::array<Named, 10> kNamed = {{
    {"table", "table-top with sphere, box, cylinder and plate; the sphere moves", table},
    {"desk", "the same with a wire across it", desk},
    {"still", "the table, nothing moves", still},
    {"left", "the static table from 40 degrees to the left", [] { return turned(-40 * kDegree); }},
    {"right", "the static table from 40 degrees to the right", [] { return turned(40 * kDegree); }},
    {"wander", "the static table with a moving camera", wandering},
    {"approach", "a wall and a ball that appear and disappear", approach},
    {"arm", "the table with an arm moving back and forth over it", arm},
    {"slant", "a table-top inclined by 65 degrees to the camera", slant},
    {"poles", "poles of 8, 15, 25 and 40 mm in front of a wall", poles},
}};

std::string name_list() {
  std::string text;
  for (const Named& named : kNamed) text += (text.empty() ? "" : ", ") + std::string(named.name);
  return text;
}

std::vector<std::string> parts_of(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == ',') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

}  // namespace

std::vector<SimulatedName> simulated_names() {
  std::vector<SimulatedName> names;
  for (const Named& named : kNamed) names.push_back({named.name, named.description});
  return names;
}

SimulatedSetup make_simulated_setup(const std::string& name) {
  for (const Named& named : kNamed) {
    if (name != named.name) continue;
    SimulatedSetup setup = named.make();
    setup.camera.name = "simulated:" + name;
    return setup;
  }
  throw Error(fmt::format("unknown simulated scene '{}'; the scenes are {}", name, name_list()));
}

std::unique_ptr<SimulatedCamera> open_simulated(const std::string& specification,
                                                const Clock* clock) {
  const std::vector<std::string> parts = parts_of(specification);
  SimulatedSetup setup = make_simulated_setup(parts[0].empty() ? "table" : parts[0]);
  setup.camera.clock = clock;
  if (clock) setup.camera.start = kPeriod * std::floor(clock->now() / kPeriod);
  for (std::size_t i = 1; i < parts.size(); ++i) set_simulated(setup, parts[i]);
  return std::make_unique<SimulatedCamera>(std::move(setup.scene), setup.camera);
}

}  // namespace palpate
