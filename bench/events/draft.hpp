#pragma once

#include "base/numbers.hpp"
#include "events/event.hpp"

namespace palpate::events {

inline constexpr double kPress = 0.003;  ///< m
inline const Eigen::Vector3d kUp = Eigen::Vector3d::UnitZ();

/// Draws a table-top that a camera looks at, and what stands, hangs and moves over it. World frame:
/// the table is z = 0, the camera is on the side of negative x.
class Draft {
 public:
  explicit Draft(std::uint64_t seed);

  double between(double low, double high) { return low + (high - low) * random_.uniform(); }
  template <std::size_t N>
  double one_of(const double (&values)[N]) {
    return values[random_.bits() % N];
  }
  Eigen::Vector3d level_direction();

  /// The camera stands there and looks at the origin.
  void look_from(const Eigen::Vector3d& eye);

  /// Unit, from x to the camera.
  [[nodiscard]] Eigen::Vector3d to_camera(const Eigen::Vector3d& x) const;

  SimulatedSolid& block(const Eigen::Vector3d& center, const Eigen::Vector3d& out,
                        const Eigen::Vector3d& half);
  SimulatedSolid& cylinder(const Eigen::Vector3d& center, const Eigen::Vector3d& axis,
                           double radius, double length);
  /// Is where it is now from `time` (s) on, and far away before; or the other way round.
  static void comes(SimulatedSolid& solid, double time);
  static void goes(SimulatedSolid& solid, double time);

  void start(const Eigen::Vector3d& hip) { event.hip = {hip}; }
  void hold(double seconds);
  void go(const Eigen::Vector3d& goal, double speed);
  /// Comes from 10 mm outside, goes so deep, rests for a second; then things happen.
  void press(const Eigen::Vector3d& at, const Eigen::Vector3d& out, double depth = kPress);
  /// Goes on from here: scores begin.
  void happens() { event.begin = event.hip.size(); }
  [[nodiscard]] double now() const { return static_cast<double>(event.hip.size()) * kTick; }

  Event event;
  Eigen::Vector3d place;  ///< on the table, m

 private:
  Random random_;
};

}  // namespace palpate::events
