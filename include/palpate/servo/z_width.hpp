#pragma once

#include <Eigen/Core>
#include <memory>
#include <string_view>

#include "palpate/device/device.hpp"
#include "palpate/device/simulated.hpp"
#include "palpate/servo/guard.hpp"

namespace palpate {

/// The stiffest wall, N/m, that gives no energy to a free device whatever the hand does
/// (Colgate and Schenkel 1997, with a delay): K = 2 b / (T + 2 T_d).
///
/// `damping`: of device and wall, N s/m. `period`: between steps, s. `delay`: from reading a
/// position to its force's effect, s, the hold of the force not counted.
[[nodiscard]] constexpr double passive_stiffness(double damping, double period,
                                                 double delay) noexcept {
  return 2 * damping / (period + 2 * delay);
}

/// The same of a device with a wall that damps with `damping` (N s/m). Unknown values are
/// assumed on the safe side: no damping, a delay of a step. Infinite where it renders no force.
[[nodiscard]] double passive_stiffness(const DeviceInfo& device, double damping) noexcept;

struct StiffnessTestOptions {
  double softest = 100;      ///< stiffness of the first wall, N/m; > 0
  double stiffest = 5000;    ///< the last one that is tried, N/m; no more than the maker allows
  double factor = 1.15;      ///< from a wall to the next; > 1
  double damping = 0;        ///< B of the walls, N s/m
  double hold = 1;           ///< s that a wall is pressed without shaking
  double patience = 30;      ///< s without progress after which the test ends
  double maximum_force = 2;  ///< N, lowered to what the device holds
  double fastest = 0.5;      ///< m/s; a device that moves faster ends the test
};

/// Tests how stiff a wall may be on this device with this hand: puts ever stiffer walls under the
/// hand until the device shakes, then removes the force. The guard works as usual, except for the
/// parts that would hide shaking (stiffness limit, passivity).
///
/// Pure: a step's force out of a step's state, no clock, no device. Real-time.
class StiffnessTest {
 public:
  /// Next task of the hand, or why the test is over.
  enum class Phase {
    rest,         ///< hold the device still: the wall is put under it; after a silence, again
    press,        ///< press down on the wall
    lift,         ///< lift it off the wall, which then becomes stiffer
    unstable,     ///< over: a wall made the device shake
    held,         ///< over: the stiffest wall stood still
    timed_out,    ///< over: nobody did what was asked
    too_fast,     ///< over: the device moved faster than any hand that presses
    device_lost,  ///< over: the device failed, or fell silent for good
  };

  struct State {
    Phase phase = Phase::rest;
    double wall = 0;       ///< stiffness now, N/m
    double stable = 0;     ///< of the stiffest wall that was pressed without shaking, N/m; 0: none
    double amplitude = 0;  ///< of the shaking now, m
    double pressed = 0;    ///< s for which this wall has been pressed
  };

  /// A swing, m, that counts as shaking when it lasts.
  static constexpr double kShaking = 0.3e-3;

  /// @throws Error when an option is out of its range or the device renders no force.
  explicit StiffnessTest(const DeviceInfo& device, const StiffnessTestOptions& options = {});
  ~StiffnessTest();

  /// The force for the hand, N, device frame, z up. `now`: s; it never goes back.
  [[nodiscard]] Eigen::Vector3d step(const DeviceState& hand, double now) noexcept;

  /// After the last step. Any thread.
  [[nodiscard]] State state() const noexcept;
  [[nodiscard]] bool is_over() const noexcept { return state().phase >= Phase::unstable; }

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

/// Returns what the hand has to do, or why the test is over.
[[nodiscard]] std::string_view in_words(StiffnessTest::Phase phase) noexcept;

/// A flat virtual wall that is rendered through a guard on a simulated device that nobody holds:
/// how stiff may it be? (Colgate and Brown 1994: the Z-width.)
struct WallOptions {
  SimulatedDeviceOptions device = {};  ///< its hand and position are ignored
  GuardOptions guard = {};             ///< its stiffness limit is ignored
  double stiffness = 500;              ///< K, N/m
  double speed = 0.1;                  ///< with which the device meets the wall, m/s
  double stretch = 5e-3;               ///< of the spring from which oscillations begin, m
};

/// The largest stiffness, N/m, within a percent, at which oscillations do not grow.
/// `wall.stiffness` is not looked at; at most kStiffestWall.
[[nodiscard]] double stable_stiffness(WallOptions wall);

/// The largest, N/m, within a percent, at which no impact comes out faster than it went in.
[[nodiscard]] double rebound_stiffness(WallOptions wall);

inline constexpr double kStiffestWall = 1e5;  ///< N/m that is looked for

}  // namespace palpate
