#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <initializer_list>
#include <vector>

#include "base/numbers.hpp"
#include "palpate/depth/depth_frame.hpp"
#include "sim/simulated_scene.hpp"

/// Scenes, cameras and hands that a seed draws, for benches of what is felt of depth streams.
namespace palpate::bench {

inline constexpr double kTick = 1e-3;  ///< s: the servo at 1 kHz
inline const Eigen::Vector3d kUp = Eigen::Vector3d::UnitZ();

/// Even between two bounds.
[[nodiscard]] inline double between(Random& random, double low, double high) {
  return low + (high - low) * random.uniform();
}

/// The pose of a camera that looks from there at something; its picture's x is level to `up`.
[[nodiscard]] Eigen::Isometry3d looking(const Eigen::Vector3d& from, const Eigen::Vector3d& at,
                                        const Eigen::Vector3d& up);

/// Removes the measurements in a disc of `radius` (m) around a place of the sensor's frame.
void punch_hole(const Eigen::Vector3d& seen, double radius, DepthFrame& frame);

/// A drawn scene: solids that may move, and the path of a hand. World frame, m, s.
struct Stage {
  explicit Stage(std::uint64_t number) : seed(number), random(number) {}

  double between(double low, double high) { return bench::between(random, low, high); }
  double one_of(std::initializer_list<double> values) {
    return *(values.begin() + random.bits() % values.size());
  }
  Eigen::Vector3d level_direction();

  /// `half`: half sizes, with z along `out`.
  SimulatedSolid& add(SolidKind kind, const Eigen::Vector3d& center, const Eigen::Vector3d& half,
                      const Eigen::Vector3d& out = kUp);
  static void moves(SimulatedSolid& solid, const Eigen::Vector3d& velocity, double begin,
                    double lasts);
  /// The solid is far away from `time` on.
  static void goes(SimulatedSolid& solid, double time);
  /// The solid is far away until `time`.
  static void comes(SimulatedSolid& solid, double time);

  /// The hand stays for `seconds`.
  void hold(double seconds);
  /// The hand goes in a straight line at `speed` (m/s).
  void go(const Eigen::Vector3d& goal, double speed);
  [[nodiscard]] double now() const { return static_cast<double>(hip.size()) * kTick; }

  std::uint64_t seed;
  Random random;
  SimulatedScene scene;
  std::vector<Eigen::Vector3d> hip;  ///< tick by tick
};

}  // namespace palpate::bench
