#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "common/rows.hpp"
#include "common/stage.hpp"
#include "sim/simulated_camera.hpp"

/// Events before one depth camera, what a hand feels of them, and how that is scored.
namespace palpate::events {

using bench::kTick;
using bench::kUp;

inline constexpr double kK = 500;        ///< N/m; judgement: the stiffness of the other benches
inline constexpr double kPress = 0.003;  ///< m; judgement: the depth of slides in table A

/// A table-top that a camera looks at, and what stands, hangs and moves over it. The table is
/// z = 0, the camera is on the side of negative x; tick 0 is the scene's time 0.
struct Event : bench::Stage {
  /// Draws table, wall, camera and place.
  explicit Event(std::uint64_t number);

  /// The camera stands there and looks at the origin.
  void look_from(const Eigen::Vector3d& eye);
  /// The same at a distance (m), so far from above (rad) on the side of negative x.
  void look_from(double tilt, double distance);
  /// Gives the camera the noise of a family of sensors: structured, stereo, tof.
  void seen_by(const std::string& family);
  /// Unit, from x to the camera.
  [[nodiscard]] Eigen::Vector3d to_camera(const Eigen::Vector3d& x) const;

  /// Leaves the table alone, so that nothing hides the place.
  void clear() { scene.solids.resize(1); }
  /// `half`: half sizes, the last along `out`.
  SimulatedSolid& block(const Eigen::Vector3d& center, const Eigen::Vector3d& out,
                        const Eigen::Vector3d& half) {
    return add(SolidKind::block, center, half, out);
  }
  SimulatedSolid& cylinder(const Eigen::Vector3d& center, const Eigen::Vector3d& axis,
                           double radius, double length) {
    return add(SolidKind::cylinder, center, {radius, radius, length / 2}, axis);
  }

  void start(const Eigen::Vector3d& at) { hip = {at}; }
  /// Comes from 10 mm outside, goes `deep` (m), rests for a second; then things happen.
  void press(const Eigen::Vector3d& at, const Eigen::Vector3d& out, double deep = kPress);
  /// Scores begin here.
  void happens() { begin = hip.size(); }

  SimulatedCameraOptions camera;
  Eigen::Vector3d place;   ///< on the table, m
  std::size_t begin = 0;   ///< tick at which things begin to happen, and scores
  double depth = 0;        ///< that the hand should be held at, m; 0: nothing should hold it
  bool when_deep = false;  ///< only while it is that deep in what stands still
  /// Spoils a frame on its way; false: it never arrives. Unset: all arrive as they are.
  std::function<bool(DepthFrame&)> fault = {};
  bool as_points = false;  ///< frames are pushed as clouds
};

using Row = bench::Row<Event>;

/// Things are hidden, appear, vanish, move fast or end.
[[nodiscard]] std::vector<Row> plain_rows();
/// Thin, slanted and rimmed things, as families of sensors see them.
[[nodiscard]] std::vector<Row> sensor_rows();
/// A letter hides some of the table that it stands on; rims behind which nothing is.
[[nodiscard]] std::vector<Row> hidden_rows();
/// Things touch, hide and pass close by; other sensors, rates and views.
[[nodiscard]] std::vector<Row> hostile_rows();
/// A sensor is at fault where a hand presses.
[[nodiscard]] std::vector<Row> fault_rows();
/// These, one after the other.
[[nodiscard]] std::vector<Row> all_rows();

/// Forces on a hand and positions of its proxy, tick by tick.
struct Felt {
  std::vector<Eigen::Vector3d> force;  ///< N
  std::vector<Eigen::Vector3d> proxy;  ///< m
  std::vector<bool> touching;
};

/// Plays the event in simulated time with the default way of feeling a depth stream.
[[nodiscard]] Felt play(const Event& event);

/// The score of one event, from where it begins.
struct Score {
  double step = 0;    ///< largest change of force from one tick to the next, N
  double most = 0;    ///< largest force, N
  double least = 1;   ///< least force of those that should hold, of K times the depth
  double last = 1;    ///< the last force alike
  double lost = 0;    ///< share of ticks with less than 20 % of that
  double behind = 0;  ///< time in which the proxy is more than 8 mm inside of something, s
  double beyond = 0;  ///< farthest that a proxy which touches is from all solids, mm
  double rms = 0;     ///< of the force about its mean over 50 ms, N
};

[[nodiscard]] Score score(const Event& event, const Felt& felt);

/// The columns of the table.
[[nodiscard]] std::span<const bench::Column<Score>> columns();

}  // namespace palpate::events
